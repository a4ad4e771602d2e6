//! Nodes and elements of an Abaqus or CalculiX input file, for drawing.
//!
//! Elements are told by the family in their type's name: `B`, `T3D`, `DASHPOT`, `SPRING` (lines), `S`, `M3D`, `CPS`, `CPE`,
//! `CAX` with their number of corners, `C3D` with their number of nodes.

use crate::edges::{Edges, Shape};
use crate::error::{FileError, Problem, quote};
use crate::number::{real, whole};
use crate::{Geometry, Node};
use std::collections::{BTreeMap, HashMap};

/// Reads the text of a file called `file` in messages.
pub fn read(text: &str, file: &str) -> Result<Geometry, FileError> {
    let mut reader = Reader::default();
    for (index, line) in text.lines().enumerate() {
        reader.line(line).map_err(|problem| FileError::line(file, index + 1, problem))?;
    }
    reader.flush();
    let notes = reader.unread.iter().map(|(name, count)| note(name, *count)).collect();
    Ok(Geometry { nodes: reader.nodes, lines: reader.edges.finish(), turned: Vec::new(), notes })
}

fn note(keyword: &str, count: usize) -> String {
    let why = match keyword {
        "*INCLUDE" => "what stands in included files is not read",
        "*TRANSFORM" => "directions of degrees of freedom are taken as global",
        "*SYSTEM" => "positions are taken as global",
        _ => "elements of this type are not drawn",
    };
    format!("{keyword} ({count} times): {why}")
}

#[derive(Debug, Default)]
enum Section {
    #[default]
    Other,
    Nodes,
    Elements(Option<Shape>),
}

#[derive(Debug, Default)]
struct Reader {
    section: Section,
    nodes: Vec<Node>,
    places: HashMap<i64, usize>,
    edges: Edges,
    /// Numbers of the element that is being read, which may go over several lines.
    element: Vec<i64>,
    unread: BTreeMap<String, usize>,
}

impl Reader {
    fn line(&mut self, line: &str) -> Result<(), Problem> {
        let line = line.trim();
        if line.is_empty() || line.starts_with("**") {
            return Ok(());
        }
        if line.starts_with('*') {
            self.flush();
            self.keyword(&line.to_uppercase());
            return Ok(());
        }
        match self.section {
            Section::Nodes => self.node(line),
            Section::Elements(_) => self.element(line),
            Section::Other => Ok(()),
        }
    }

    fn keyword(&mut self, line: &str) {
        let mut words = line.split(',').map(|word| word.split_whitespace().collect::<String>());
        let name = words.next().unwrap_or_default();
        let kind = words.find_map(|word| word.strip_prefix("TYPE=").map(str::to_owned));
        self.section = match (name.as_str(), kind) {
            ("*NODE", _) => Section::Nodes,
            ("*ELEMENT", Some(kind)) => {
                let shape = shape(&kind);
                if shape.is_none() {
                    *self.unread.entry(format!("*ELEMENT, TYPE={kind}")).or_default() += 1;
                }
                Section::Elements(shape)
            }
            _ => Section::Other,
        };
        if ["*INCLUDE", "*TRANSFORM", "*SYSTEM"].contains(&name.as_str()) {
            *self.unread.entry(name).or_default() += 1;
        }
    }

    fn node(&mut self, line: &str) -> Result<(), Problem> {
        let mut words = line.split(',');
        let id = whole(words.next().unwrap_or_default(), "a node number")?;
        let mut position = [0.0; 3];
        for (value, word) in position.iter_mut().zip(words.filter(|word| !word.trim().is_empty())) {
            *value = real(word)?;
        }
        match self.places.get(&id) {
            Some(&known) if self.nodes[known].position != position => Err(Problem::NodeTwice { id }),
            Some(_) => Ok(()),
            None => {
                self.places.insert(id, self.nodes.len());
                self.nodes.push(Node { id, position });
                Ok(())
            }
        }
    }

    fn element(&mut self, line: &str) -> Result<(), Problem> {
        for word in line.split(',').map(str::trim).filter(|word| !word.is_empty()) {
            self.element.push(
                whole(word, "an element or node number")
                    .map_err(|_| Problem::Row { expected: "element, node, node, ...", text: quote(line) })?,
            );
        }
        if !line.ends_with(',') {
            self.flush();
        }
        Ok(())
    }

    fn flush(&mut self) {
        if let (Section::Elements(Some(shape)), [_, nodes @ ..]) = (&self.section, &self.element[..]) {
            // CalculiX writes the nodes of a long element on two lines without a comma in some files; corners come first.
            self.edges.add(*shape, nodes);
        }
        self.element.clear();
    }
}

/// Shape of an element type such as `C3D20R`, `S8R`, `B32`, `T3D2`, `DASHPOTA`.
fn shape(kind: &str) -> Option<Shape> {
    let digits = |prefix: &str| {
        let rest = kind.strip_prefix(prefix)?;
        rest.chars().take_while(char::is_ascii_digit).collect::<String>().parse::<usize>().ok()
    };
    if let Some(nodes) = digits("C3D") {
        return match nodes {
            4 | 10 => Some(Shape::Tetrahedron),
            6 | 15 => Some(Shape::Wedge),
            8 | 20 | 27 => Some(Shape::Hexahedron),
            _ => None,
        };
    }
    if digits("B").is_some() || digits("T3D").is_some() || digits("T2D").is_some() {
        return Some(Shape::Line);
    }
    if kind.starts_with("DASHPOT") || kind.starts_with("SPRING") {
        return Some(Shape::Line);
    }
    ["S", "M3D", "CPS", "CPE", "CAX"].into_iter().find_map(digits).and_then(|nodes| match nodes {
        3 | 6 => Some(Shape::Polygon(3)),
        4 | 8 | 9 => Some(Shape::Polygon(4)),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn nodes_and_lines() {
        let text = "** a model\n*Node, nset=all\n1, 0., 0., 0.\n 2, 1.D0\n3, 1.0, 1.0\n*ELEMENT, TYPE=B31, ELSET=e\n1, 1, 2\n2,2,\n3\n*element,type=mass\n7,1\n*Include, input=x\n";
        let geometry = read(text, "a.inp").unwrap();
        assert_eq!(geometry.nodes[1], Node { id: 2, position: [1.0, 0.0, 0.0] });
        assert_eq!(geometry.lines, [[1, 2], [2, 3]]);
        assert_eq!(geometry.notes.len(), 2);
        assert!(geometry.notes[1].starts_with("*INCLUDE (1 times): what stands in included"), "{:?}", geometry.notes);
    }

    #[test]
    fn errors_name_the_line() {
        let message = |text: &str| read(text, "a.inp").unwrap_err().to_string();
        assert_eq!(message("*NODE\n1,0,0,x\n"), "a.inp:2: \"x\" is not a finite number; export the file again");
        assert!(message("*NODE\n1,0\n1,1\n").starts_with("a.inp:3: node 1 is given twice"));
        assert!(message("*ELEMENT,TYPE=B31\n1,a\n").starts_with("a.inp:2: \"1,a\" is not `element, node"));
    }
}
