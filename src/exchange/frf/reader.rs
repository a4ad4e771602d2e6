//! Files of frequency responses of every format: which reader a file needs, and which labels it names.

use super::checks::same_frequencies;
use super::data_files;
use super::error::{FrfError, FrfProblem};
use super::source::FrfSource;
use super::universal::Reader;
use crate::control::Control;
use crate::measurement::frf::ResponseSet;
use crate::structure::Structure;
use std::path::Path;
use uff::File;

/// The functions of a file on their common frequencies, and the faults that were read over.
pub(crate) fn read_responses(
    path: &Path,
    name: &str,
    source: &FrfSource,
    structure: &Structure,
    control: &Control,
) -> Result<(ResponseSet, Vec<String>), FrfError> {
    let in_file = |problem| FrfError { file: path.display().to_string(), problem };
    if source.columns.is_some() || !is_universal(path) {
        return data_files::read(path, name, source, structure, control).map_err(in_file);
    }
    let mut file = File::open(path).map_err(|error| in_file(FrfProblem::File(error)))?;
    Reader { file: &mut file, source, structure }.read(name, control).map_err(in_file)
}

/// The functions of all files of a test on their common frequencies, and the faults that were read over; `names` are those
/// of the files from `folder`.
///
/// # Errors
/// [`FrfError`]: the file and what is wrong.
pub(crate) fn read_test(
    folder: &Path,
    names: &[&String],
    source: &FrfSource,
    structure: &Structure,
    control: &Control,
) -> Result<(ResponseSet, Vec<String>), FrfError> {
    let (mut test, mut faults): (Option<ResponseSet>, _) = (None, Vec::new());
    let mut source = source.clone();
    for name in names {
        let path = folder.join(name);
        let (set, more) = read_responses(&path, name, &source, structure, control)?;
        faults.extend(more);
        source.before += set.functions.len();
        match &mut test {
            None => test = Some(set),
            Some(test) => {
                join(test, set).map_err(|problem| FrfError { file: path.display().to_string(), problem })?;
            }
        }
    }
    let mut test = test.unwrap_or_else(|| ResponseSet { averages: source.averages, ..ResponseSet::default() });
    if let Some(stated) = source.stated().filter(|stated| *stated != test.functions.len() && control.check().is_ok()) {
        let (count, has) = (test.functions.len(), if names.len() == 1 { "has" } else { "and the files with it have" });
        let what =
            format!("{has} {count} functions, and `responses` times `references` are {stated}; name every column");
        return Err(FrfError { file: folder.join(names[0]).display().to_string(), problem: FrfProblem::Data(what) });
    }
    if names.len() > 1 {
        test.name = format!("{} and {} with it", test.name, names.len() - 1);
    }
    Ok((test, faults))
}

/// Adds the functions of a further file.
fn join(test: &mut ResponseSet, set: ResponseSet) -> Result<(), FrfProblem> {
    if !same_frequencies(&test.frequencies_hz, &set.frequencies_hz) {
        let what = format!("its frequencies are not those of {}; give it an [[frf]] of its own", test.name);
        return Err(FrfProblem::Data(what));
    }
    for function in set.functions {
        if test.functions.iter().any(|f| f.response == function.response && f.reference == function.reference) {
            let what = format!(
                "{} over {} is in a file before it already; keep one of them, or give it an [[frf]] of its own",
                function.response, function.reference
            );
            return Err(FrfProblem::Data(what));
        }
        test.functions.push(function);
    }
    Ok(())
}

/// Whether a file is a Universal File: -1 stands alone in its first line that is not blank.
fn is_universal(path: &Path) -> bool {
    use std::io::Read;
    let mut start = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(4096).read_to_end(&mut start));
    let text = String::from_utf8_lossy(&start);
    let universal =
        path.extension().is_some_and(|end| ["uff", "unv", "ufb"].iter().any(|e| end.eq_ignore_ascii_case(e)));
    universal || read.is_err() || text.lines().map(str::trim).find(|line| !line.is_empty()) == Some("-1")
}

/// Labels in a structure of nodes and directions that the functions of a file may stand for, such as `12z`.
pub(crate) fn labels_in(path: &Path) -> Vec<String> {
    let Ok(file) = dashpot_datafiles::open(path) else { return Vec::new() };
    let functions = file.contents().sets.iter().filter(|set| set.kind == dashpot_datafiles::Kind::Frf);
    let mut labels: Vec<String> = Vec::new();
    for channel in functions.flat_map(|set| &set.channels) {
        let pair = [channel.attribute("response"), channel.attribute("reference")].map(|text| text.map(str::to_owned));
        let pair = match pair {
            [Some(response), Some(reference)] => Some([response, reference]),
            _ => super::names::pair_in_name(&channel.name),
        };
        for text in pair.into_iter().flatten() {
            let plain = text.rsplit(' ').next().unwrap_or_default().rsplit('@').next().unwrap_or_default();
            let label: String = plain.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_lowercase();
            for one in [label, plain.to_owned()] {
                if !labels.contains(&one) {
                    labels.push(one);
                }
            }
        }
    }
    labels
}
