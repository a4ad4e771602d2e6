//! HDF5 files, and MAT files of version 7.3, which are HDF5 with MATLAB's own attributes.
//!
//! The tree is made of headers and a few values of each data set; chunks that no listing shows are never read.

mod column;
mod fault;
mod lzf;
mod peek;
mod value;

use crate::contents::{Contents, Format};
use crate::error::{Fault, Read, one_line};
use crate::source::{MOST_VALUES, Source};
use crate::tree::{Array, Arrays, Cut, Entry, Flat, Node, Shape, TreeSource, sets};
use fault::wrong;
use hdf5_reader::group::Group;
use hdf5_reader::{Attribute, Dataset, Datatype, Hdf5File, OpenOptions};
use peek::{SMALL, peek};
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use value::{Field, Value};

/// Deepest groups.
const DEEPEST: usize = 32;
/// Most groups and data sets of a file.
const MOST_ENTRIES: usize = 200_000;
/// Most bytes that one byte of a file unpacks to: deflate gives 1032 at most, and files have headers too.
const UNPACKED: u64 = 1100;
/// Largest chunk, bytes.
const LARGEST_CHUNK: u64 = 1 << 28;
/// Most texts of a data set that are kept.
const MOST_TEXTS: u64 = 4096;

struct Hdf5 {
    datasets: Vec<Stored>,
    // Data sets hold on to the file by themselves.
    _file: Hdf5File,
}

/// A data set, or a field of its records, and what turns its numbers into those that are meant.
struct Stored {
    dataset: Dataset,
    field: Option<Field>,
    factor: f64,
    offset: f64,
}

/// Opens an HDF5 file; `matlab` where its user block is that of MATLAB 7.3.
pub(crate) fn open(path: &Path, matlab: bool) -> Read<(Contents, Box<dyn Source>)> {
    let length = std::fs::metadata(path)?.len();
    // What a header states is bounded by what the file can hold; a little more for fill values.
    let holds = length.saturating_mul(UNPACKED).max(1 << 20);
    let options = OpenOptions::default()
        .with_max_read_bytes(holds.saturating_mul(16).min(MOST_VALUES * 16) as usize)
        .with_filter_registry(lzf::filters())
        .with_max_chunk_bytes(holds.min(LARGEST_CHUNK) as usize)
        // Channels are read chunk by chunk, each once.
        .with_chunk_cache_bytes(16 << 20)
        .with_max_object_header_bytes(1 << 24);
    let file = Hdf5File::open_with_options(path, options).map_err(wrong)?;
    let root = file.root_group().map_err(wrong)?;
    let mut walk =
        Walk { matlab, length, datasets: Vec::new(), seen: HashSet::new(), references: BTreeMap::new(), entries: 0 };
    if matlab && let Ok(group) = root.group("#refs#") {
        walk.references = references(&group);
    }
    let mut entries = walk.group(&root, 0)?;
    if matlab {
        entries.retain(|entry| !entry.name.starts_with('#'));
    }
    let attributes = if matlab { Vec::new() } else { attributes(root.attributes().map_err(wrong)?) };
    let arrays = Hdf5 { datasets: walk.datasets, _file: file };
    let (sets, places) = sets(&entries, &attributes, &arrays)?;
    let mut contents = Contents::new(if matlab { Format::Mat } else { Format::Hdf5 });
    contents.sets = sets;
    if contents.sets.is_empty() {
        contents.notes.push("there is no data set of numbers".into());
    }
    Ok((contents, Box::new(TreeSource::new(Box::new(arrays), places))))
}

/// Objects that cells of MATLAB refer to, by their address.
fn references(group: &Group) -> BTreeMap<u64, Object> {
    let Ok((groups, datasets)) = group.members() else { return BTreeMap::new() };
    let groups = groups.into_iter().map(|group| (group.address(), Object::Group(group)));
    groups.chain(datasets.into_iter().map(|dataset| (dataset.address(), Object::Dataset(dataset)))).collect()
}

#[derive(Clone)]
enum Object {
    Group(Group),
    Dataset(Dataset),
}

struct Walk {
    matlab: bool,
    /// Bytes of the file.
    length: u64,
    datasets: Vec<Stored>,
    /// Addresses of the groups that are being walked, against links that lead back.
    seen: HashSet<u64>,
    references: BTreeMap<u64, Object>,
    entries: usize,
}

impl Walk {
    fn group(&mut self, group: &Group, depth: usize) -> Read<Vec<Entry>> {
        if depth > DEEPEST || !self.seen.insert(group.address()) {
            return Ok(vec![Entry::new("…", Node::Skipped("it leads back to a group above it".to_owned()))]);
        }
        let mut entries = Vec::new();
        let (groups, datasets) = match group.members() {
            Ok(members) => members,
            Err(_) => self.one_by_one(group, &mut entries)?,
        };
        for dataset in datasets {
            self.count()?;
            entries.push(self.dataset(dataset, depth));
        }
        for inner in groups {
            self.count()?;
            if self.matlab && inner.name().starts_with('#') {
                continue;
            }
            let name = inner.name().to_owned();
            let fields = self.group(&inner, depth + 1)?;
            let node = Node::Group(if self.matlab { value::elements(fields) } else { fields });
            let attributes = inner.attributes().map(attributes).unwrap_or_default();
            entries.push(Entry { name, node, attributes });
        }
        self.seen.remove(&group.address());
        Ok(entries)
    }

    /// Members where not all can be opened: those that cannot are said.
    fn one_by_one(&self, group: &Group, entries: &mut Vec<Entry>) -> Read<(Vec<Group>, Vec<Dataset>)> {
        let (groups, datasets) = group.member_names().map_err(wrong)?;
        let mut found = (Vec::new(), Vec::new());
        let skipped = |name: &str, error: hdf5_reader::error::Error| {
            Entry::new(name, Node::Skipped(one_line(&error.to_string(), 120)))
        };
        for name in groups {
            match group.group(&name) {
                Ok(inner) => found.0.push(inner),
                Err(error) => entries.push(skipped(&name, error)),
            }
        }
        for name in datasets {
            match group.dataset(&name) {
                Ok(dataset) => found.1.push(dataset),
                Err(error) => entries.push(skipped(&name, error)),
            }
        }
        Ok(found)
    }

    fn count(&mut self) -> Read<()> {
        self.entries += 1;
        if self.entries > MOST_ENTRIES {
            return Err(Fault::new(format!(
                "has more than {MOST_ENTRIES} groups and data sets; export the measurement alone"
            )));
        }
        Ok(())
    }

    fn dataset(&mut self, dataset: Dataset, depth: usize) -> Entry {
        let name = dataset.name().rsplit('/').next().unwrap_or_default().to_owned();
        let raw = dataset.attributes();
        let class = raw.iter().find(|attribute| attribute.name == "MATLAB_class").and_then(|a| a.read_string().ok());
        let empty = raw.iter().any(|attribute| attribute.name == "MATLAB_empty");
        let attributes = attributes(raw);
        let node = match (class.as_deref(), dataset.dtype()) {
            _ if empty => Node::Text(vec![String::new()]),
            (Some("char"), _) => text(&dataset).unwrap_or_else(skipped),
            (Some("cell"), _) => self.cell(&dataset, depth, ["{", "}"]),
            // A field of an array of structs.
            (None, Datatype::Reference { .. }) if self.matlab => self.cell(&dataset, depth, ["(", ")"]),
            (Some(class @ ("string" | "table" | "datetime" | "timetable" | "function_handle")), _) => {
                Node::Skipped(format!("it is an object of MATLAB ({class}); save its numbers as arrays"))
            }
            (_, Datatype::String { .. } | Datatype::VarLen { .. }) => texts(&dataset).unwrap_or_else(skipped),
            (_, dtype) if value::readable(dtype).is_some() => {
                self.numbers(dataset, &attributes).unwrap_or_else(skipped)
            }
            (_, Datatype::Compound { .. }) => self.records(&dataset).unwrap_or_else(skipped),
            _ => Node::Skipped("its values are no numbers".to_owned()),
        };
        Entry { name, node, attributes }
    }

    /// A cell of MATLAB: references to what is in it, each named by its number in brackets.
    fn cell(&mut self, dataset: &Dataset, depth: usize, [open, close]: [&str; 2]) -> Node {
        if depth > DEEPEST || dataset.num_elements().is_ok_and(|count| count > MOST_TEXTS) {
            return Node::Skipped("the cell is too large or too deep; save its parts alone".to_owned());
        }
        let Ok(bytes) = dataset.read_raw_bytes() else {
            return Node::Skipped("the references of the cell are damaged".to_owned());
        };
        let mut entries = Vec::new();
        for (i, reference) in bytes.chunks_exact(8).enumerate() {
            let address = u64::from_le_bytes(reference.try_into().unwrap_or_default());
            let name = format!("{open}{}{close}", i + 1);
            let entry = match self.references.get(&address).cloned() {
                Some(Object::Dataset(dataset)) => self.dataset(dataset, depth + 1),
                Some(Object::Group(group)) => match self.group(&group, depth + 1) {
                    Ok(entries) => Entry::new("", Node::Group(entries)),
                    Err(fault) => Entry::new("", Node::Skipped(fault.problem)),
                },
                None => Entry::new("", Node::Skipped("it refers to nothing".to_owned())),
            };
            entries.push(Entry { name, ..entry });
        }
        crate::tree::of_cell(entries)
    }

    fn numbers(&mut self, dataset: Dataset, attributes: &[(String, String)]) -> Read<Node> {
        let mut extents = dataset.shape().to_vec();
        if self.matlab {
            extents.reverse();
        }
        let shape = Shape::new(extents, self.matlab);
        let complex = value::readable(dataset.dtype()).unwrap_or(false);
        self.fits(&dataset)?;
        let mut peek = peek(&dataset, &shape)?;
        let whole = matches!(dataset.dtype(), Datatype::FixedPoint { .. });
        let (factor, offset) = scaling(attributes, whole);
        if !complex {
            peek.iter_mut().for_each(|value| value[0] = value[0] * factor + offset);
        }
        let id = self.datasets.len();
        self.datasets.push(Stored { dataset, field: None, factor, offset });
        Ok(Node::Array(Array { id, shape, complex, peek }))
    }

    /// A fault where a data set states more than the file can hold, so that no memory follows a damaged extent.
    fn fits(&self, dataset: &Dataset) -> Read<()> {
        let count = dataset.num_elements().map_err(wrong)?;
        let size = dataset.raw_element_size().map_err(wrong)? as u64;
        let most = if dataset.chunks().is_some() { self.length.saturating_mul(UNPACKED) } else { self.length };
        if count > SMALL && count.saturating_mul(size) > most {
            return Err(Fault::new(format!(
                "it states {count} values of {size} bytes, more than a file of {} bytes holds; it was not written to its end, or is \
                 damaged: export it again",
                self.length
            )));
        }
        Ok(())
    }

    /// Records, such as tables of pandas and PyTables: a group with an array a numeric field.
    fn records(&mut self, dataset: &Dataset) -> Read<Node> {
        let fields = value::fields(dataset.dtype());
        if fields.is_empty() {
            return Ok(Node::Skipped(
                "its values are records without a number; save each field as a data set".to_owned(),
            ));
        }
        self.fits(dataset)?;
        let shape = Shape::new(dataset.shape().to_vec(), false);
        let wanted = shape.wanted();
        let rows = value::peek_records(dataset, &wanted).map_err(wrong)?;
        let mut entries = Vec::new();
        for field in fields {
            let peek = rows.iter().map(|row| [field.number(row).unwrap_or(f64::NAN), 0.0]).collect();
            let id = self.datasets.len();
            let name = field.name.clone();
            self.datasets.push(Stored { dataset: dataset.clone(), field: Some(field), factor: 1.0, offset: 0.0 });
            let array = Array { id, shape: shape.clone(), complex: false, peek };
            entries.push(Entry::new(name, Node::Array(array)));
        }
        Ok(Node::Group(entries))
    }
}

/// Factor and offset by the convention of NetCDF (`scale_factor`, `add_offset`); of whole numbers also by plainer words.
fn scaling(attributes: &[(String, String)], whole: bool) -> (f64, f64) {
    let number = |words: &[&str]| {
        let said = attributes.iter().find(|(name, _)| words.contains(&name.to_lowercase().as_str()));
        said.and_then(|(_, value)| value.trim().parse::<f64>().ok()).filter(|value| value.is_finite())
    };
    let plain: &[&str] = if whole { &["scale", "scaling", "slope", "conversion_factor", "lsb"] } else { &[] };
    let shift: &[&str] = if whole { &["offset", "intercept"] } else { &[] };
    let factor = number(&["scale_factor"]).or_else(|| number(plain)).filter(|factor| *factor != 0.0);
    // An offset alone may be anything, such as that of the first sample.
    let offset = number(&["add_offset"]).or_else(|| factor.and_then(|_| number(shift)));
    (factor.unwrap_or(1.0), offset.unwrap_or(0.0))
}

fn skipped(fault: Fault) -> Node {
    Node::Skipped(fault.problem)
}

/// Text of MATLAB: numbers of letters, columns first.
fn text(dataset: &Dataset) -> Read<Node> {
    if dataset.num_elements().map_err(wrong)? > 1 << 16 {
        return Ok(Node::Text(vec!["(long text)".to_owned()]));
    }
    let values = dataset.read_array::<Value>().map_err(wrong)?;
    let units = values.iter().map(|value| value.0[0] as u16);
    let text: String = char::decode_utf16(units).map(|c| c.unwrap_or('?')).collect();
    Ok(Node::Text(vec![one_line(&text, 400)]))
}

fn texts(dataset: &Dataset) -> Read<Node> {
    if dataset.num_elements().map_err(wrong)? > MOST_TEXTS {
        return Ok(Node::Skipped("it is text".to_owned()));
    }
    let texts = dataset.read_strings().map_err(wrong)?;
    Ok(Node::Text(texts.iter().map(|text| one_line(text.trim_end_matches('\0'), 400)).collect()))
}

/// Attributes as words and values, those of MATLAB and of dimension scales left out.
fn attributes(attributes: Vec<Attribute>) -> Vec<(String, String)> {
    let own = |name: &str| {
        name.starts_with("MATLAB_") || matches!(name, "H5PATH" | "CLASS" | "DIMENSION_LIST" | "REFERENCE_LIST" | "NAME")
    };
    let value = |attribute: &Attribute| {
        if let Ok(text) = attribute.read_string() {
            return Some(text);
        }
        if let Ok(texts) = attribute.read_strings() {
            return Some(texts.join(", "));
        }
        let one = attribute.num_elements().is_ok_and(|count| count == 1);
        one.then(|| attribute.read_as_f64().ok().map(|value| value.to_string())).flatten()
    };
    let pair = |attribute: Attribute| Some((attribute.name.clone(), one_line(&value(&attribute)?, 200)));
    attributes.into_iter().filter(|attribute| !own(&attribute.name)).filter_map(pair).collect()
}

impl Arrays for Hdf5 {
    fn read(&self, id: usize) -> Read<Flat> {
        let stored = self.datasets.get(id).ok_or_else(|| Fault::new("there is no such data set"))?;
        let dataset = &stored.dataset;
        if dataset.num_elements().map_err(wrong)? > MOST_VALUES {
            return Err(Fault::new("is too large for memory; save it in pieces"));
        }
        if let Some(field) = &stored.field {
            return Ok(Flat { re: field.column(dataset).map_err(wrong)?, im: Vec::new() });
        }
        let values = dataset.read_array_uncached::<Value>().map_err(wrong)?;
        let complex = value::readable(dataset.dtype()).unwrap_or(false);
        let re = values.iter().map(|value| value.0[0]).collect();
        let im = if complex { values.iter().map(|value| value.0[1]).collect() } else { Vec::new() };
        Ok(stored.scaled(Flat { re, im }))
    }

    fn column(&self, id: usize, cut: &Cut, channel: u64) -> Option<Read<Flat>> {
        let only_column = |mut flats: Vec<Flat>| flats.pop().ok_or_else(|| Fault::new("there is no such channel"));
        self.columns(id, cut, &[channel]).map(|flats| flats.and_then(only_column))
    }

    fn columns(&self, id: usize, cut: &Cut, channels: &[u64]) -> Option<Read<Vec<Flat>>> {
        let stored = self.datasets.get(id).filter(|stored| stored.field.is_none())?;
        let complex = value::readable(stored.dataset.dtype()).unwrap_or(false);
        let read = column::columns(&stored.dataset, cut, channels, complex)?;
        Some(read.map(|flats| flats.into_iter().map(|flat| stored.scaled(flat)).collect()))
    }
}

impl Stored {
    fn scaled(&self, mut flat: Flat) -> Flat {
        if self.factor != 1.0 || self.offset != 0.0 {
            flat.re.iter_mut().for_each(|value| *value = *value * self.factor + self.offset);
        }
        flat
    }
}
