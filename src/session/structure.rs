//! The numbers of the structure of a project, set by name.

use super::refusal::Refusal;
use crate::exchange::project::file::Shape;

/// Word for the kind of structure.
pub(super) fn kind(shape: &Shape) -> &'static str {
    match shape {
        Shape::Beam(_) => "beam",
        Shape::Chain(_) => "chain",
        Shape::Matrices(_) => "structure of matrices",
        Shape::Points(_) => "structure of points",
        Shape::Component(_) => "component",
    }
}

/// Sets a number by its key; a member of a list is `masses[2]`, counted from 1.
pub(super) fn set_number(shape: &mut Shape, name: &str, value: f64) -> Result<(), Refusal> {
    if let Shape::Beam(beam) = shape
        && name == "elements"
    {
        beam.elements = whole(name, value)?;
        return Ok(());
    }
    let unknown = unknown_number(shape, name);
    *number(shape, name).ok_or(unknown)? = value;
    Ok(())
}

fn whole(name: &str, value: f64) -> Result<usize, Refusal> {
    let usable = (1.0..=1e9).contains(&value) && value.fract() == 0.0;
    if usable { Ok(value as usize) } else { Err(Refusal::NotWhole { name: name.into(), value }) }
}

fn number<'a>(shape: &'a mut Shape, name: &str) -> Option<&'a mut f64> {
    match shape {
        Shape::Beam(beam) => match name {
            "length" => Some(&mut beam.length),
            "breadth" => Some(&mut beam.breadth),
            "depth" => Some(&mut beam.depth),
            "youngs_modulus" => Some(&mut beam.youngs_modulus),
            "density" => Some(&mut beam.density),
            _ => None,
        },
        Shape::Chain(chain) => {
            let (list, rest) = name.split_once('[')?;
            let index = rest.strip_suffix(']')?.parse::<usize>().ok()?.checked_sub(1)?;
            match list {
                "masses" => chain.masses.get_mut(index),
                "ground_stiffness" => chain.ground_stiffness.get_mut(index),
                "coupling_stiffness" => chain.coupling_stiffness.get_mut(index),
                _ => None,
            }
        }
        Shape::Matrices(_) | Shape::Points(_) | Shape::Component(_) => None,
    }
}

fn unknown_number(shape: &Shape, name: &str) -> Refusal {
    let known = match shape {
        Shape::Beam(_) => "length, breadth, depth, youngs_modulus, density, elements".into(),
        Shape::Chain(chain) => {
            let (n, m) = (chain.masses.len(), chain.coupling_stiffness.len());
            format!("masses[1..{n}], ground_stiffness[1..{n}], coupling_stiffness[1..{m}]")
        }
        Shape::Matrices(_) | Shape::Points(_) | Shape::Component(_) => "none".into(),
    };
    Refusal::NoSuchNumber { kind: kind(shape), name: name.into(), known }
}
