//! The values of a function: columns of text, or IEEE 754 floats.

use super::header::{Binary, ByteOrder, FunctionHeader};
use crate::body::{Body, Odd};
use crate::error::{Error, Problem};
use crate::values::Values;
use crate::warning::Fault;

/// Uneven abscissas where there are any, and ordinates.
type Data = (Option<Vec<f64>>, Values);

/// Values written as text: numbers in the order abscissa, real, imaginary part.
pub(super) fn text(body: &mut Body<'_>, header: &FunctionHeader) -> Result<Data, Error> {
    let per_value = header.numbers_per_value();
    let wanted = usize::try_from(header.count.saturating_mul(per_value)).unwrap_or(usize::MAX);
    let mut numbers = Vec::with_capacity(wanted.min(body.rest().len() / 2 + 1));
    let (mut odd, mut left_out) = (Odd::default(), 0);
    while let Some(line) = body.line() {
        if numbers.len() == wanted && odd.surplus.is_none() {
            odd.surplus = Some((line, 0));
        }
        body.reals_of(line, wanted, &mut numbers, &mut odd)?;
    }
    odd.tell(body);
    if let Some((line, surplus)) = odd.surplus {
        left_out += surplus;
        if left_out > 0 {
            body.warn(line, Fault::Surplus { declared: header.count, left_out });
        }
    }
    let found = numbers.len() as u64 / per_value;
    if numbers.len() < wanted {
        body.warn_here(Fault::Truncated { declared: header.count, found });
    }
    Ok(split(numbers, header))
}

/// Numbers of whole values, taken apart.
fn split(mut numbers: Vec<f64>, header: &FunctionHeader) -> Data {
    let per_value = header.numbers_per_value() as usize;
    numbers.truncate(numbers.len() / per_value * per_value);
    if header.even {
        return (None, Values::from_numbers(numbers, header.complex));
    }
    let abscissas = numbers.chunks_exact(per_value).map(|one| one[0]).collect();
    let ordinates = numbers.chunks_exact(per_value).flat_map(|one| one[1..].iter().copied()).collect();
    (Some(abscissas), Values::from_numbers(ordinates, header.complex))
}

/// Binary values.
pub(super) fn binary(body: &mut Body<'_>, header: &FunctionHeader) -> Result<Data, Error> {
    let Some(binary) = header.binary else { return text(body, header) };
    check_format(body, &binary)?;
    skip_lines(body, &binary);
    let bytes = body.rest();
    let (size, narrow) = layout(body, header);
    let bytes = &bytes[..size.min(bytes.len())];
    let order = binary.order.unwrap_or_else(|| plausible_order(bytes, header.double));
    if binary.order.is_none() {
        body.warn_here(Fault::ByteOrder { found: binary.order_said });
    }
    let numbers = if narrow { mixed(bytes, header, order) } else { floats(bytes, header.double, order) };
    let not_finite = numbers.iter().filter(|x| !x.is_finite()).count() as u64;
    if not_finite > 0 {
        body.warn_here(Fault::NotFinite { values: not_finite });
    }
    let found = numbers.len() as u64 / header.numbers_per_value();
    if found < header.count {
        body.warn_here(Fault::Truncated { declared: header.count, found });
    }
    Ok(split(numbers, header))
}

fn check_format(body: &Body<'_>, binary: &Binary) -> Result<(), Error> {
    let name = match binary.format {
        1 => "DEC VMS",
        3 => "IBM 5/370",
        _ => return Ok(()),
    };
    Err(body.error_here(Problem::FloatingFormat { found: binary.format, name }))
}

/// Lines of text beyond the eleven that are known.
fn skip_lines(body: &mut Body<'_>, binary: &Binary) {
    if binary.lines == 11 {
        return;
    }
    body.warn_here(Fault::HeaderLines { declared: binary.lines });
}

/// Number of bytes to read, and whether the abscissas are single beside double ordinates. Tells a wrong byte count.
fn layout(body: &mut Body<'_>, header: &FunctionHeader) -> (usize, bool) {
    let [all, narrow] = header.binary_sizes();
    let there = body.rest().len() as u64;
    let declared = header.binary.map_or(0, |binary| binary.bytes);
    let single_abscissa = narrow != all && there < all && there >= narrow;
    let needed = if single_abscissa { narrow } else { all };
    let size = needed.min(there);
    if declared != size {
        body.warn_here(Fault::ByteCount { declared, found: size });
    }
    let stray = there - size;
    let ends = body.rest()[size as usize..].iter().filter(|b| !b.is_ascii_whitespace()).count() as u64;
    if stray > 2 || ends > 0 {
        body.warn_here(Fault::StrayBytes { bytes: stray });
    }
    (size as usize, single_abscissa)
}

/// All numbers of one precision.
fn floats(bytes: &[u8], double: bool, order: ByteOrder) -> Vec<f64> {
    if double {
        bytes.as_chunks().0.iter().map(|&b| f64_of(b, order)).collect()
    } else {
        bytes.as_chunks().0.iter().map(|&b| f32_of(b, order)).collect()
    }
}

/// Single abscissas beside double ordinates.
fn mixed(bytes: &[u8], header: &FunctionHeader, order: ByteOrder) -> Vec<f64> {
    let ordinates = 1 + usize::from(header.complex);
    let mut numbers = Vec::with_capacity(bytes.len() / 8 + 1);
    for one in bytes.chunks_exact(4 + 8 * ordinates) {
        let (abscissa, rest) = one.split_at(4);
        numbers.extend(floats(abscissa, false, order));
        numbers.extend(floats(rest, true, order));
    }
    numbers
}

fn f64_of(bytes: [u8; 8], order: ByteOrder) -> f64 {
    match order {
        ByteOrder::Little => f64::from_le_bytes(bytes),
        ByteOrder::Big => f64::from_be_bytes(bytes),
    }
}

fn f32_of(bytes: [u8; 4], order: ByteOrder) -> f64 {
    f64::from(match order {
        ByteOrder::Little => f32::from_le_bytes(bytes),
        ByteOrder::Big => f32::from_be_bytes(bytes),
    })
}

/// The order in which fewer of the first values are absurd.
fn plausible_order(bytes: &[u8], double: bool) -> ByteOrder {
    const LOOKED_AT: usize = 8 * 256;
    let head = &bytes[..bytes.len().min(LOOKED_AT)];
    let absurd = |order| {
        let wrong = |x: &f64| !x.is_finite() || (*x != 0.0 && !(1e-20..1e20).contains(&x.abs()));
        floats(head, double, order).iter().filter(|x| wrong(x)).count()
    };
    if absurd(ByteOrder::Big) < absurd(ByteOrder::Little) { ByteOrder::Big } else { ByteOrder::Little }
}
