//! NASTRAN bulk data and punch files.
//!
//! A card is one line and its continuations. Small field: ten fields of 8 characters; large (`*` after the name): 16; free: commas.
//! Data fields are numbered from 0 behind the name, over all lines: a small line holds eight, a large one four. What stands
//! before `BEGIN BULK` (where there is one), comments (`$`) and cards that are not listed in [`crate`] are passed over.

mod cards;
mod coordinates;
mod dmig;

use crate::edges::{Edges, Shape};
use crate::error::{FileError, Problem};
use crate::number::{real, whole};
use crate::{Geometry, Matrix, Node, Turned};
use cards::{Card, cards, is_begin};
use coordinates::Systems;
use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};

/// Nodes, lines and matrices of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bulk {
    /// Nodes, lines and notes.
    pub geometry: Geometry,
    /// Every `DMIG`, in the order of the file.
    pub matrices: Vec<Matrix>,
}

/// Reads the text of a file called `file` in messages. Included files are said in the notes; [`read_parts`] reads them too.
pub fn read(text: &str, file: &str) -> Result<Bulk, FileError> {
    let mut bulk = read_parts(&[(text, file)])?;
    if !includes(text).is_empty() {
        bulk.geometry.notes.push("what stands in included files is not read".to_owned());
    }
    Ok(bulk)
}

/// Reads a deck with the files that it includes: the text of each and its name in messages.
pub fn read_parts(parts: &[(&str, &str)]) -> Result<Bulk, FileError> {
    let texts: Vec<Cow<'_, str>> = parts.iter().map(|(text, _)| without_tabs(text)).collect();
    if let Some((part, line)) = cut_short(&texts) {
        return Err(FileError::line(parts[part].1, line, Problem::NoEnd));
    }
    let mut reader = Reader::default();
    for (text, (_, file)) in texts.iter().zip(parts) {
        for card in cards(text) {
            reader.card(&card, file).map_err(|problem| FileError::line(file, card.line, problem))?;
        }
    }
    reader.finish(parts.first().map_or("", |(_, file)| *file))
}

/// Part and last line of a deck whose bulk data begin and do not end: of a matrix any number of columns may be missing. `ENDDATA`
/// may stand in a file that is included; where these are not at hand, nothing can be said.
fn cut_short(texts: &[Cow<'_, str>]) -> Option<(usize, usize)> {
    let begins = |text: &Cow<'_, str>| text.lines().any(is_begin);
    let is_end = |line: &str| line.trim_start().get(..7).is_some_and(|word| word.eq_ignore_ascii_case("enddata"));
    let ends = texts.iter().any(|text| text.lines().any(is_end));
    let unread = texts.len() == 1 && !includes(&texts[0]).is_empty();
    let part = texts.iter().position(begins).filter(|_| !ends && !unread)?;
    Some((part, texts[part].lines().count()))
}

/// Files that a deck includes, with the lines (from 1) that say so.
pub fn includes(text: &str) -> Vec<(usize, String)> {
    let included = |(index, line): (usize, &str)| {
        let line = line.split('$').next()?.trim();
        let (word, name) = line.split_once([' ', '\t', '=', '\'', '"'])?;
        let name = name.trim().trim_matches(['\'', '"']).trim();
        (word.eq_ignore_ascii_case("include") && !name.is_empty()).then(|| (index + 1, name.to_owned()))
    };
    text.lines().enumerate().filter_map(included).collect()
}

/// The text with its tabs as blanks: fields begin at every eighth column.
fn without_tabs(text: &str) -> Cow<'_, str> {
    if !text.contains('\t') {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + text.len() / 4);
    for line in text.lines() {
        let mut column = 0;
        for letter in line.chars() {
            if letter == '\t' {
                let blanks = 8 - column % 8;
                out.extend(std::iter::repeat_n(' ', blanks));
                column += blanks;
            } else {
                out.push(letter);
                column += 1;
            }
        }
        out.push('\n');
    }
    Cow::Owned(out)
}

/// A grid point before its coordinate system is known.
struct Grid<'a> {
    file: &'a str,
    line: usize,
    id: i64,
    /// Coordinate system of the position; the default of `GRDSET` where the card has none.
    system: &'a str,
    /// Coordinate system of the displacements.
    directions: &'a str,
    position: [f64; 3],
}

#[derive(Default)]
struct Reader<'a> {
    grids: Vec<Grid<'a>>,
    defaults: [&'a str; 2],
    systems: Systems,
    edges: Edges,
    matrices: dmig::Matrices,
    /// Number of grid points of the fluid.
    fluid: usize,
}

impl<'a> Reader<'a> {
    fn card(&mut self, card: &Card<'a>, file: &'a str) -> Result<(), Problem> {
        match card.name.as_str() {
            "GRID" => self.grid(card, file)?,
            "GRDSET" => self.defaults = [card.field(1), card.field(5)],
            "CORD2R" | "CORD2C" | "CORD2S" => self.systems.add(card)?,
            "CORD1R" | "CORD1C" | "CORD1S" => self.systems.add_by_grids(card)?,
            "DMIG" => self.matrices.card(card)?,
            name => return self.element(name, card),
        }
        Ok(())
    }

    fn grid(&mut self, card: &Card<'a>, file: &'a str) -> Result<(), Problem> {
        let mut position = [0.0; 3];
        for (k, value) in position.iter_mut().enumerate() {
            let text = card.field(2 + k);
            *value = if text.is_empty() { 0.0 } else { real(text)? };
        }
        let id = whole(card.field(0), "a grid point number")?;
        let (system, directions) = (card.field(1), card.field(5));
        self.grids.push(Grid { file, line: card.line, id, system, directions, position });
        Ok(())
    }

    fn element(&mut self, name: &str, card: &Card<'_>) -> Result<(), Problem> {
        // First field of the grid points and their number.
        let (shape, first, count) = match name {
            "CBAR" | "CBEAM" | "CBEND" | "CROD" | "CTUBE" | "CBUSH" => (Shape::Line, 2, 2),
            "CONROD" => (Shape::Line, 1, 2),
            "PLOTEL" => {
                // Two elements may stand on one card.
                let second = [card.field(5), card.field(6)];
                if second.iter().all(|text| !text.is_empty()) {
                    self.edges.add(Shape::Line, &[grid(second[0])?, grid(second[1])?]);
                }
                (Shape::Line, 1, 2)
            }
            "CTRIA3" | "CTRIA6" | "CTRIAR" => (Shape::Polygon(3), 2, 3),
            "CQUAD4" | "CQUAD8" | "CQUADR" | "CSHEAR" => (Shape::Polygon(4), 2, 4),
            "CTETRA" => (Shape::Tetrahedron, 2, 4),
            "CPENTA" => (Shape::Wedge, 2, 6),
            "CHEXA" => (Shape::Hexahedron, 2, 8),
            _ => return Ok(()),
        };
        let words = (first..first + count).map(|k| card.field(k)).filter(|text| !text.is_empty());
        let nodes = words.map(grid).collect::<Result<Vec<i64>, Problem>>()?;
        self.edges.add(shape, &nodes);
        Ok(())
    }

    fn finish(mut self, file: &str) -> Result<Bulk, FileError> {
        let (nodes, turned) = self.nodes()?;
        let (matrices, skipped) = self.matrices.finish(file)?;
        let mut notes = notes(&turned, self.fluid);
        notes.extend(skipped);
        Ok(Bulk { geometry: Geometry { nodes, lines: self.edges.finish(), turned, notes }, matrices })
    }

    /// Positions in the basic system, and the nodes whose displacements are in others.
    fn nodes(&mut self) -> Result<(Vec<Node>, Vec<Turned>), FileError> {
        let mut stated = Vec::with_capacity(self.grids.len());
        for grid in &self.grids {
            let wrong = |problem| FileError::line(grid.file, grid.line, problem);
            let [system, directions] = [(grid.system, self.defaults[0]), (grid.directions, self.defaults[1])]
                .map(|(own, otherwise)| system(if own.is_empty() { otherwise } else { own }).map_err(wrong));
            let (system, directions) = (system?, directions?);
            self.systems.place(grid.id, system, grid.position);
            stated.push((system, directions));
        }
        let (mut nodes, mut turned) = (Vec::with_capacity(self.grids.len()), Vec::new());
        let mut places: HashMap<i64, usize> = HashMap::new();
        for (grid, (system, directions)) in self.grids.iter().zip(stated) {
            let wrong = |problem| FileError::line(grid.file, grid.line, problem);
            let position = self.systems.basic(system, grid.position).map_err(wrong)?;
            match places.get(&grid.id) {
                Some(&known) if nodes[known] == Node { id: grid.id, position } => continue,
                Some(_) => return Err(wrong(Problem::NodeTwice { id: grid.id })),
                None => places.insert(grid.id, nodes.len()),
            };
            nodes.push(Node { id: grid.id, position });
            self.fluid += usize::from(directions < 0);
            if directions > 0 {
                let axes = self.systems.directions(directions, position).map_err(wrong)?;
                turned.push(Turned { node: grid.id, system: directions, axes });
            }
        }
        Ok((nodes, turned))
    }
}

/// What is said of nodes whose directions are not those of the basic system.
fn notes(turned: &[Turned], fluid: usize) -> Vec<String> {
    let mut systems: BTreeMap<i64, usize> = BTreeMap::new();
    turned.iter().for_each(|node| *systems.entry(node.system).or_default() += 1);
    let of_system = |(id, count): (&i64, &usize)| {
        format!(
            "displacements of {count} grid points are in coordinate system {id}: they are turned to x, y and z of the basic system"
        )
    };
    let fluid =
        (fluid > 0).then(|| format!("{fluid} grid points are those of the fluid, with pressures in place of motions"));
    systems.iter().map(of_system).chain(fluid).collect()
}

fn grid(text: &str) -> Result<i64, Problem> {
    whole(text, "a grid point number")
}

fn system(text: &str) -> Result<i64, Problem> {
    if text.is_empty() { Ok(0) } else { whole(text, "a coordinate system number") }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::NodeDof;

    const SMALL: &str = "\
SOL 103
BEGIN BULK
$ a comment
GRID           1              0.      0.      0.
GRID*                  2                             1.5              0.
*                     0.
GRID,3,,3.,1.-1
CBAR           1       1       1       2      0.      0.      1.
CROD,2,1,2,3
PLOTEL         9       1       3
DMIG        KAAX       0       6       1       0
DMIG        KAAX       1       3               1       3  2500.0
               2       3   -1.+3
DMIG        KAAX       2       3               2       3  1000.0
ENDDATA
";

    #[test]
    fn small_large_and_free_field() {
        let bulk = read(SMALL, "m.bdf").unwrap();
        let at: Vec<[f64; 3]> = bulk.geometry.nodes.iter().map(|node| node.position).collect();
        assert_eq!(at, [[0.0; 3], [1.5, 0.0, 0.0], [3.0, 0.1, 0.0]]);
        assert_eq!(bulk.geometry.lines, [[1, 2], [2, 3], [1, 3]]);
        let k = &bulk.matrices[0];
        assert_eq!((k.name.as_str(), k.size), ("KAAX", 2));
        assert_eq!(k.dofs.as_ref().unwrap()[1], NodeDof { node: 2, component: 3 });
        assert_eq!(k.entries, [(0, 0, 2500.0), (1, 0, -1000.0), (1, 1, 1000.0)]);
    }

    #[test]
    fn a_deck_without_its_end_may_be_cut_short() {
        for lines in [5, 13] {
            let cut: String = SMALL.lines().take(lines).map(|line| format!("{line}\n")).collect();
            let said = read(&cut, "m.bdf").unwrap_err().to_string();
            let expected = "no ENDDATA follows BEGIN BULK, so the file may have been cut short; copy or export it again, or, where it is \
                            whole, add a last line ENDDATA";
            assert_eq!(said, format!("m.bdf:{lines}: {expected}"));
        }
    }

    #[test]
    fn the_end_of_a_deck_may_stand_in_a_file_that_it_includes() {
        let deck = ("SOL 103\nBEGIN BULK\nINCLUDE 'mesh.bdf'\n", "m.bdf");
        let mesh = ("GRID,1,,0.\nENDDATA\n", "mesh.bdf");
        assert_eq!(read_parts(&[deck, mesh]).unwrap().geometry.nodes.len(), 1);
        // The bulk data as a whole in a file of their own, below the case control of another.
        let parts = [("SOL 103\nINCLUDE 'bulk.bdf'\n", "m.bdf"), ("BEGIN BULK\nGRID,1,,0.\n", "bulk.bdf")];
        let said = read_parts(&parts).unwrap_err().to_string();
        assert!(said.starts_with("bulk.bdf:2: no ENDDATA follows BEGIN BULK"), "{said}");
        // Files that are not at hand may have it.
        assert!(read(deck.0, deck.1).is_ok());
        // What is included, or nothing but bulk data, needs none.
        assert!(read("GRID,1,,0.\n", "mesh.bdf").is_ok());
    }

    #[test]
    fn punch_of_large_field() {
        let text = [
            "$TITLE",
            "DMIG*               MAAX               0               6               2",
            "*                      0",
            "DMIG*               MAAX              11               1                ",
            "*                     11               1 2.500000000D+00",
            "*                     12               1-1.000000000D+00",
        ]
        .join("\n");
        let bulk = read(&text, "m.pch").unwrap();
        assert_eq!(bulk.matrices[0].entries, [(0, 0, 2.5), (1, 0, -1.0)]);
    }

    #[test]
    fn tabs_and_included_files() {
        let deck = "BEGIN BULK\nINCLUDE 'mesh.bdf'\nCBAR\t1\t1\t1\t2\nENDDATA\n";
        assert_eq!(includes(deck), [(2, "mesh.bdf".to_owned())]);
        let mesh = "GRID\t1\t\t0.\t0.\t0.\nGRID\t2\t\t1.5\t0.\t0.\n";
        let bulk = read_parts(&[(deck, "m.bdf"), (mesh, "mesh.bdf")]).unwrap();
        assert_eq!(bulk.geometry.nodes[1].position, [1.5, 0.0, 0.0]);
        assert_eq!(bulk.geometry.lines, [[1, 2]]);
        let wrong = read_parts(&[(deck, "m.bdf"), ("GRID,1,,x\n", "mesh.bdf")]).unwrap_err().to_string();
        assert!(wrong.starts_with("mesh.bdf:1: "), "{wrong}");
    }

    #[test]
    fn positions_in_other_systems() {
        // A cylinder whose axis is x: theta from y.
        let text = "CORD2C,5,,1.,0.,0.,2.,0.,0.\n,1.,1.,0.\nGRID,1,5,2.,90.,3.,5\n";
        let bulk = read(text, "m.bdf").unwrap();
        let position = bulk.geometry.nodes[0].position;
        let exact = [4.0, 0.0, 2.0];
        assert!((0..3).all(|k| (position[k] - exact[k]).abs() < 1e-14), "{position:?}");
        assert!(bulk.geometry.notes[0].starts_with("displacements of 1 grid points are in coordinate system 5"));
    }

    #[test]
    fn errors_name_the_line() {
        let message = |text: &str| read(text, "m.bdf").unwrap_err().to_string();
        assert_eq!(message("GRID,1,,0.,x,0.\n"), "m.bdf:1: \"x\" is not a finite number; export the file again");
        assert!(message("GRID,1,7,0.\n").contains("coordinate system 7 is not given"));
        assert!(message("\nDMIG,K,1,1,,1,1,2.\n").starts_with("m.bdf:2: matrix K has no header card"));
        assert!(read("DMIG,K,0,6,1,0\nDMIG,K,1,1,,1,1,2.\nDMIG,P,0,9,1,0,,,1\nDMIG,P,1,0,,1,1,9.\n", "m").is_ok_and(
            |bulk| {
                bulk.matrices.len() == 1
                    && bulk.geometry.notes == ["matrix P has form 9; use 1 (square) or 6 (symmetric): it is not read"]
            }
        ));
        assert!(message("DMIG,K,0,6,4,0\n").starts_with("m.bdf:1: matrix K is complex"));
        assert!(message("DMIG,K,0,2,1,0\n").starts_with("m.bdf:1: matrix K has form 2"));
        assert!(message("DMIG,K,0,6,1,0\nDMIG,K,1,7,,1,1,2.\n").starts_with("m.bdf:2: component 7 is not"));
        assert!(message("GRID,1,,0.\nGRID,1,,1.\n").starts_with("m.bdf:2: node 1 is given twice"));
        let odd = "DMIG,K,0,1,1,0\nDMIG,K,1,1,,1,1,2.,,\n,2,1,1.\nDMIG,K,2,1,,1,1,-1.,,\n,2,1,2.\n";
        assert!(message(odd).starts_with("m.bdf: matrix K is not symmetric: row 2.1, column 1.1"), "{}", message(odd));
    }
}
