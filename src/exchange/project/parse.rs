//! From text to [`ProjectFile`]: every key known, every value of its type; nothing else is read.

use super::error::{ProjectError, TableProblem};
use super::file::{
    CandidatesTable, FORMAT, Header, Lines, MatricesTable, PointsTable, ProjectFile, SensorTable, Shape, SimulateTable,
    SourceTable, StructureTable,
};
use super::keys::elements;
use super::label::Label;
use super::reader::{Origin, Table};
use super::runs::{harmonics, runs};
use super::{base, channel, correction, frf, modes, reduce, report, ruled_out};
use crate::effects::Effect;
use crate::effects::family::Family;
use crate::identify::Settings;
use crate::structure::LumpedMass;
use crate::structure::beam::BeamParameters;
use crate::structure::chain::ChainParameters;
use crate::structure::component::ComponentParameters;
use std::collections::BTreeMap;

/// Keys of every `[structure]` with matrices; the others are those of its kind.
const STRUCTURE: [&str; 3] = ["kind", "lumped_mass", "correction"];

/// Most harmonics, sources and so on that a setting may ask for.
const MOST: usize = 1000;
/// Most samples or periods of a simulated record.
const MOST_SAMPLES: usize = 100_000_000;

type Read<T> = Result<T, ProjectError>;

impl ProjectFile {
    /// Reads the text of a project that is called `file` in messages.
    ///
    /// # Errors
    /// [`ProjectError`] with the line of the first thing that is wrong.
    pub fn parse(text: &str, file: &str) -> Result<(Self, Lines), ProjectError> {
        let origin = Origin { file, text };
        let document = origin.document()?;
        let root = Table::root(origin, document.get_ref());
        // The version first: a newer file may have keys that are not known here.
        let project = header(&root)?;
        root.only_in::<Self>(&[])?;
        let mut lines = Lines::default();
        let parsed = Self {
            project,
            structure: structure(&root, &mut lines)?,
            source: sources(&root, &mut lines)?,
            candidates: candidates(&root, &mut lines)?,
            sensor: sensors(&root, &mut lines)?,
            ruled_out: ruled_out::parse(&root, &mut lines)?,
            channel: channel::parse(&root, &mut lines)?,
            run: runs(&root, &mut lines)?,
            harmonics: harmonics(&root, &mut lines)?,
            frf: frf::parse(&root, &mut lines)?,
            modes: modes::parse(&root, &mut lines)?,
            base: base::parse(&root)?,
            analysis: analysis(&root)?,
            simulate: simulate(&root, &mut lines)?,
            report: report::parse(&root)?,
        };
        Ok((parsed, lines))
    }
}

fn header(root: &Table<'_>) -> Read<Header> {
    let table = root.need("project", "[project]", root.table("project", "[project]")?)?;
    let format = table.need("format", "format = 1", table.whole("format")?)?;
    if format.unsigned_abs() > FORMAT && format > 0 {
        return Err(table.error("format", TableProblem::Newer { found: format.unsigned_abs() }));
    }
    if format < 1 {
        let problem = TableProblem::OutOfRange { key: "format".into(), value: format.to_string(), range: "1" };
        return Err(table.error("format", problem));
    }
    table.only_in::<Header>(&[])?;
    let title = table.text("title")?.unwrap_or_default();
    Ok(Header { format: FORMAT, title, notes: table.text("notes")?.unwrap_or_default() })
}

fn structure(root: &Table<'_>, lines: &mut Lines) -> Read<StructureTable> {
    let table = root.need("structure", "[structure]", root.table("structure", "[structure]")?)?;
    lines.note(&table);
    let kinds = ["beam", "chain", "matrices", "points", "component"];
    let kind = table.word("kind", &kinds, |word| kinds.iter().position(|&kind| kind == word))?;
    let shape = match table.need("kind", "kind = \"beam\"", kind)? {
        0 => Shape::Beam(beam(&table)?),
        1 => Shape::Chain(chain(&table)?),
        2 => Shape::Matrices(matrices(&table)?),
        3 => Shape::Points(points(&table)?),
        _ => Shape::Component(component(&table)?),
    };
    let mut lumped_mass = Vec::new();
    for entry in table.tables("lumped_mass", "[[structure.lumped_mass]]")? {
        entry.only_in::<LumpedMass>(&[])?;
        lines.note(&entry);
        let dof = entry.need("dof", "dof = 3", entry.label("dof")?)?;
        lumped_mass.push(LumpedMass { dof, mass: entry.need("mass", "mass = 0.1", entry.number("mass")?)? });
    }
    let correction = correction::parse(&table, lines)?;
    Ok(StructureTable { shape, lumped_mass, correction })
}

fn beam(table: &Table<'_>) -> Read<BeamParameters> {
    table.only_in::<BeamParameters>(&STRUCTURE)?;
    let number = |key: &'static str, example| table.need(key, example, table.number(key)?);
    let elements = table.count("elements", 1, 10_000, "between 1 and 10000")?;
    Ok(BeamParameters {
        length: number("length", "length = 0.56")?,
        breadth: number("breadth", "breadth = 0.04")?,
        depth: number("depth", "depth = 0.004")?,
        youngs_modulus: number("youngs_modulus", "youngs_modulus = 69e9")?,
        density: number("density", "density = 2700.0")?,
        elements: table.need("elements", "elements = 10", elements)?,
        supports: table.need("supports", "supports = \"clamped-free\"", table.variant("supports")?)?,
    })
}

fn chain(table: &Table<'_>) -> Read<ChainParameters> {
    table.only_in::<ChainParameters>(&STRUCTURE)?;
    let list = |key: &'static str, example| table.need(key, example, table.numbers(key)?);
    Ok(ChainParameters {
        masses: list("masses", "masses = [1.0, 2.0]")?,
        ground_stiffness: list("ground_stiffness", "ground_stiffness = [1e5, 0.0]")?,
        coupling_stiffness: list("coupling_stiffness", "coupling_stiffness = [1e5]")?,
    })
}

fn matrices(table: &Table<'_>) -> Read<MatricesTable> {
    table.only_in::<MatricesTable>(&STRUCTURE)?;
    Ok(MatricesTable {
        mass: table.need("mass", "mass = \"mass.mtx\"", table.text("mass")?)?,
        stiffness: table.need("stiffness", "stiffness = \"stiffness.mtx\"", table.text("stiffness")?)?,
        nodes: table.text("nodes")?,
        dofs: table.text("dofs")?,
        lines: table.text("lines")?,
        mass_name: table.text("mass_name")?,
        stiffness_name: table.text("stiffness_name")?,
        reduce: table.table("reduce", "[structure.reduce]")?.map(|table| reduce::parse(&table)).transpose()?,
    })
}

fn points(table: &Table<'_>) -> Read<PointsTable> {
    table.only_in::<PointsTable>(&STRUCTURE[..2])?;
    let dofs = table.need("dofs", "dofs = [\"1\", \"2\"]", table.labels("dofs")?)?;
    Ok(PointsTable { dofs: dofs.into_iter().map(Label).collect(), positions: table.positions("positions")? })
}

fn component(table: &Table<'_>) -> Read<ComponentParameters> {
    table.only_in::<ComponentParameters>(&STRUCTURE[..2])?;
    Ok(ComponentParameters {
        dof: table.label("dof")?.unwrap_or_else(|| "1".into()),
        mass: table.number("mass")?.unwrap_or(0.0),
    })
}

/// The law of a table, and its parameters by name; `base` are the table's other keys.
fn law(table: &Table<'_>, base: &[&'static str]) -> Read<(Effect, BTreeMap<String, f64>)> {
    let names = Effect::ALL.map(Effect::name);
    let effect = table.word("law", &names, Effect::from_name)?;
    let effect = table.need("law", "law = \"viscous\"", effect)?;
    let known: Vec<&str> = base.iter().copied().chain(effect.parameters().iter().map(|p| p.name)).collect();
    table.only(&known)?;
    let mut parameters = BTreeMap::new();
    for parameter in effect.parameters() {
        if let Some(value) = table.number(parameter.name)? {
            parameters.insert(parameter.name.to_owned(), value);
        }
    }
    Ok((effect, parameters))
}

fn sources(root: &Table<'_>, lines: &mut Lines) -> Read<Vec<SourceTable>> {
    let mut sources = Vec::new();
    for table in root.tables("source", "[[source]]")? {
        let (law, parameters) = law(&table, &["law", "dofs", "elements", "state"])?;
        let state = table.need("state", "state = \"candidate\"", table.variant("state")?)?;
        let dofs = table.labels("dofs")?.unwrap_or_default().into_iter().map(Label).collect();
        sources.push(SourceTable { law, dofs, elements: elements(&table)?, state, parameters });
        lines.note(&table);
    }
    Ok(sources)
}

fn candidates(root: &Table<'_>, lines: &mut Lines) -> Read<Vec<CandidatesTable>> {
    let mut families = Vec::new();
    for table in root.tables("candidates", "[[candidates]]")? {
        let (law, parameters) = law(&table, &["law", "where"])?;
        let family = table.word("where", &Family::ALL.map(Family::name), Family::from_name)?;
        let family = table.need("where", "where = \"each-translation\"", family)?;
        families.push(CandidatesTable { law, family, parameters });
        lines.note(&table);
    }
    Ok(families)
}

fn sensors(root: &Table<'_>, lines: &mut Lines) -> Read<Vec<SensorTable>> {
    let mut sensors = Vec::new();
    for table in root.tables("sensor", "[[sensor]]")? {
        table.only_in::<SensorTable>(&[])?;
        let channel = table.need("channel", "channel = \"acc@7\"", table.text("channel")?)?;
        let (delay, gain) = (super::keys::delay(&table)?, table.number("gain")?);
        if delay.is_none() && gain.is_none() {
            table.need::<()>("gain", "gain = 1.02` or `delay = 1e-4", None)?;
        }
        sensors.push(SensorTable { channel, delay, gain });
        lines.note(&table);
    }
    Ok(sensors)
}

fn analysis(root: &Table<'_>) -> Read<Settings> {
    let mut settings = Settings::default();
    let Some(table) = root.table("analysis", "[analysis]")? else { return Ok(settings) };
    table.only_in::<Settings>(&[])?;
    let count = |key, least, range, otherwise| Ok(table.count(key, least, MOST, range)?.unwrap_or(otherwise));
    settings.harmonics = count("harmonics", 1, "between 1 and 1000", settings.harmonics)?;
    settings.keep = count("keep", 0, "between 0 and 1000", settings.keep)?;
    settings.max_sources = count("max_sources", 1, "between 1 and 1000", settings.max_sources)?;
    settings.expansion = table.variant("expansion")?.unwrap_or_default();
    settings.weights = table.variant("weights")?.unwrap_or_default();
    if let Some(value) = table.number("stop_angle_deg")? {
        if !(0.0..=90.0).contains(&value) {
            let (key, range) = ("stop_angle_deg".to_owned(), "between 0 and 90 degrees");
            return Err(
                table.error("stop_angle_deg", TableProblem::OutOfRange { key, value: value.to_string(), range })
            );
        }
        settings.stop_angle_deg = value;
    }
    Ok(settings)
}

fn simulate(root: &Table<'_>, lines: &mut Lines) -> Read<SimulateTable> {
    let mut recipe = SimulateTable::default();
    let Some(table) = root.table("simulate", "[simulate]")? else { return Ok(recipe) };
    table.only_in::<SimulateTable>(&[])?;
    lines.note(&table);
    recipe.channels = table.texts("channels")?.unwrap_or_default();
    let range = "between 16 and 100000000";
    recipe.samples = table.count("samples", 16, MOST_SAMPLES, range)?.unwrap_or(recipe.samples);
    recipe.periods = table.count("periods", 1, MOST_SAMPLES, "at least 1")?.unwrap_or(recipe.periods);
    recipe.integrate = table.flag("integrate")?.unwrap_or(false);
    recipe.rate_hz = table.number("rate_hz")?;
    if let Some(value) = recipe.rate_hz.filter(|rate| *rate <= 0.0) {
        let (key, range) = ("rate_hz".to_owned(), "above 0 Hz");
        return Err(table.error("rate_hz", TableProblem::OutOfRange { key, value: value.to_string(), range }));
    }
    recipe.bits = table.count("bits", 4, 32, "between 4 and 32")?.map(|bits| bits as u32);
    recipe.filter = table.flag("filter")?.unwrap_or(true);
    Ok(recipe)
}
