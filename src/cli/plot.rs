//! `dashpot plot`: one plot of a project as SVG, or its values as CSV. Needs no display and no graphics adapter.

use super::arguments::{Plot, PlotKind};
use super::identified;
use super::plot_records::RecordPlots;
use crate::control::Control;
use crate::diagnosis::component::{Loops, compare_component};
use crate::diagnosis::records::compare::OneRecord;
use crate::diagnosis::result::{Suggestion, Verdict};
use crate::diagnosis::{Comparison, compare};
use crate::display::words;
use crate::exchange::Project;
use crate::exchange::atomic::write_atomically;
use crate::exchange::project::load;
use crate::identify::Outcome;
use crate::measurement::{Quantity, TransientRun};
use crate::plots::bars::{self, Bar};
use crate::plots::bode::{Diagram, ReceptanceCurve};
use crate::plots::channel_response::ChannelResponse;
use crate::plots::cycle::Cycle;
use crate::plots::drawing::Drawing;
use crate::plots::error_map::{Grid, Scale};
use crate::plots::figure::{Figure, csv};
use crate::plots::heatmap::{HeatMap, occupied};
use crate::plots::record::RecordPlot;
use crate::plots::record_residual::RecordResidual;
use crate::plots::sheet::Sheet;
use crate::plots::style::Palette;
use crate::plots::trace::{Trace, trace};
use crate::plots::{
    self, amplitude_curve, angle, component_loops, energy, forward, response_curve, samples, spectrum, svg,
};
use crate::session::validation::{
    as_runs, compared_with_records, diagnosed, is_component, missing_force, only_records, problem,
};
use crate::session::workers::Threads;
use anyhow::{Context, bail, ensure};
use clap::ValueEnum;
use std::path::Path;
use std::sync::Arc;

/// A plot on paper, and its values as a table with tabs.
struct Drawn {
    drawing: Drawing,
    table: String,
}

/// Draws and writes.
pub(super) fn run(arguments: &Plot) -> anyhow::Result<String> {
    let ending = arguments.out.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase();
    ensure!(
        ["svg", "csv"].contains(&ending.as_str()),
        "--out {}: a plot is written as .svg, its values as .csv; `dashpot picture` draws pixels",
        arguments.out.display()
    );
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let mut project = load(&arguments.file, &control)?;
    if arguments.what.compares() && !only_records(&project) {
        identified::take_over(&mut project, false, &arguments.file, &control)?;
    }
    let plotter = Plotter { arguments, p: &project, palette: palette(arguments), control: &control };
    let drawn = plotter.draw().with_context(|| arguments.file.display().to_string())?;
    let text = if ending == "svg" { svg::write(&drawn.drawing) } else { csv(&drawn.table) };
    write(&arguments.out, &text)?;
    Ok(format!("Written: {}.\n", arguments.out.display()))
}

fn write(path: &Path, text: &str) -> anyhow::Result<()> {
    write_atomically(path, text.as_bytes()).with_context(|| format!("{}: cannot be written", path.display()))
}

fn palette(arguments: &Plot) -> &'static Palette {
    if arguments.theme == "dark" { Palette::dark() } else { Palette::light() }
}

struct Plotter<'a> {
    arguments: &'a Plot,
    p: &'a Project,
    palette: &'static Palette,
    control: &'a Control,
}

impl Plotter<'_> {
    fn draw(&self) -> anyhow::Result<Drawn> {
        let what = self.arguments.what;
        let steady = what.is_of_runs() || what == PlotKind::Hysteresis && !is_component(self.p);
        ensure!(
            !(steady && only_records(self.p)),
            "{} is a plot of steady runs, and the project has none; its records are drawn by --what record, amplitude, \
             error-map, angle, shares and matrix",
            what.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned())
        );
        match what {
            PlotKind::Record if !self.is_modelled() => self.figure(self.records().record()?),
            PlotKind::Overview => self.overview(),
            PlotKind::Angle => {
                let o = self.outcome()?;
                self.figure(angle::figure(self.palette, &o, o.accepted, self.p.settings.stop_angle_deg))
            }
            PlotKind::Energy => {
                let o = self.outcome()?;
                self.figure(energy::figure(self.palette, self.p, &o, o.accepted))
            }
            PlotKind::Shares => self.shares(),
            PlotKind::Matrix => self.matrix(),
            PlotKind::Bode | PlotKind::Nyquist => self.response(),
            PlotKind::Hysteresis if is_component(self.p) => self.component_loop(),
            PlotKind::Hysteresis => self.hysteresis(),
            PlotKind::Spectrogram | PlotKind::Amplitude => self.unsteady(),
            PlotKind::Record | PlotKind::Spectrum if only_records(self.p) => self.unsteady(),
            PlotKind::Record | PlotKind::Spectrum => self.record(),
            PlotKind::ErrorMap => self.error_map(),
            PlotKind::RestoringForce => self.restoring_force(),
            PlotKind::Channel | PlotKind::Level | PlotKind::Period | PlotKind::Loop => self.channel(),
        }
    }

    /// Whether there is something to compare records that are not steady with; of steady runs, always.
    fn is_modelled(&self) -> bool {
        !only_records(self.p) || !is_component(self.p) && self.p.structure.matrices().is_some()
    }

    fn records(&self) -> RecordPlots<'_> {
        let Plotter { arguments, p, palette, .. } = *self;
        RecordPlots { p, run: arguments.run, channel: arguments.channel.as_deref(), palette }
    }

    fn overview(&self) -> anyhow::Result<Drawn> {
        let run = self.run()?;
        let channel = &self.p.runs[run].fit.channels[self.channel_index(run)?].channel;
        let figures = plots::overview::figures(self.p, channel, run, self.palette);
        ensure!(!figures.is_empty(), "no run with {channel} has a force to divide by");
        self.sheet(&format!("{channel} over the force, all runs"), figures.into_iter().map(|f| f.0).collect())
    }

    fn figure(&self, figure: Figure) -> anyhow::Result<Drawn> {
        let title = figure.title.clone();
        self.sheet(&title, vec![figure])
    }

    fn sheet(&self, title: &str, figures: Vec<Figure>) -> anyhow::Result<Drawn> {
        ensure!(!figures.is_empty(), "there is nothing to plot");
        let sheet = Sheet::of(title, figures);
        let size = self.arguments.size.map_or_else(|| sheet.paper(), |[w, h]| emath::vec2(w as f32, h as f32));
        Ok(Drawn { drawing: sheet.drawing(size, self.palette), table: sheet.table() })
    }

    /// Of the suggestion at the DOF that was asked for, else of the first; without one of the place that explains most.
    fn restoring_force(&self) -> anyhow::Result<Drawn> {
        let p = self.p;
        let diagnosis = diagnosed(p, self.control, &|_| {})?;
        let dof = self.dof()?;
        let is_at_place = |s: &&Suggestion| match &s.added.source.place {
            crate::effects::Place::Dofs(dofs) => dof.is_none_or(|d| dofs.contains(&d)),
            _ => false,
        };
        let suggestion = diagnosis.suggestions.iter().find(is_at_place);
        ensure!(
            suggestion.is_some() || dof.is_none(),
            "--dof {}: no suggestion is there; `dashpot diagnose` lists them",
            self.arguments.dof.as_deref().unwrap_or_default()
        );
        ensure!(
            suggestion.is_some() || diagnosis.verdict == Verdict::Unexplained,
            "no force is missing at a place of the structure: {}",
            crate::display::findings::sentence(&diagnosis)
        );
        let source = suggestion.map(|s| &s.added.source);
        let force = missing_force(p, &diagnosis, source, self.control)?;
        let force = force.context("no run shows the force well enough to draw it")?;
        let sheet = plots::restoring_force::sheet(&force, &p.structure, self.palette);
        let size = self.arguments.size.map_or_else(|| sheet.paper(), |[w, h]| emath::vec2(w as f32, h as f32));
        Ok(Drawn { drawing: sheet.drawing(size, self.palette), table: plots::restoring_force::table(&force) })
    }

    fn outcome(&self) -> anyhow::Result<Outcome> {
        Ok(self.p.identify(&[], self.control)?)
    }

    fn comparison(&self) -> anyhow::Result<Comparison> {
        if only_records(self.p) {
            let found = compared_with_records(self.p, self.control)?;
            let found = found.context("records are compared with a model of mass and stiffness; points have none")?;
            return Ok(as_runs(self.p, &found));
        }
        Ok(compare(&problem(self.p), &[], self.control)?)
    }

    /// Index of the run that was asked for, else of the first that is used.
    fn run(&self) -> anyhow::Result<usize> {
        let runs = &self.p.runs;
        match self.arguments.run {
            Some(number) if (1..=runs.len()).contains(&number) => Ok(number - 1),
            Some(number) => bail!("--run {number}: the project has runs 1 to {}", runs.len()),
            None => runs.iter().position(|r| r.enabled).context("the project has no run that is used"),
        }
    }

    /// Row of the DOF that was asked for.
    fn dof(&self) -> anyhow::Result<Option<usize>> {
        let Some(label) = &self.arguments.dof else { return Ok(None) };
        let dofs = self.p.structure.dofs();
        let found = dofs.iter().position(|d| d.label == *label);
        let known = || dofs.iter().take(12).map(|d| d.label.as_str()).collect::<Vec<_>>().join(", ");
        found.map(Some).with_context(|| format!("--dof {label}: there is no such DOF; the first are {}", known()))
    }

    fn shares(&self) -> anyhow::Result<Drawn> {
        let o = self.outcome()?;
        let bar = |e: &crate::identify::Estimate| {
            let s = self.p.sources.get(e.source)?;
            let name = format!("{} {}", s.effect.title().to_owned(), s.place.cell(&self.p.structure));
            Some(Bar { name, share: 0.01 * e.energy_percent, colour: self.palette.model })
        };
        let list: Vec<Bar> = o.sources.iter().filter_map(bar).collect();
        let drawing = bars::draw(&list, "Energy by source", 240.0, self.palette);
        Ok(Drawn { drawing, table: bars::table(&list) })
    }

    fn matrix(&self) -> anyhow::Result<Drawn> {
        let o = self.outcome()?;
        let (matrix, title) = if o.results.others.is_empty() {
            (&o.results.viscous, "Damping matrix")
        } else {
            (&o.results.equivalent_viscous, "Damping matrix, viscous of equal energy")
        };
        let rows = occupied(matrix);
        ensure!(!rows.is_empty(), "the damping matrix is empty");
        let labels: Vec<String> = self.p.structure.dofs().iter().map(|d| d.label.clone()).collect();
        let map = HeatMap { matrix, rows: &rows, columns: &rows, labels: &labels, unit: "N s/m", scale: None };
        Ok(Drawn { drawing: map.paper(title, self.palette), table: map.table() })
    }

    /// Of the identified model; of the known sources where the project has nothing to identify.
    fn response(&self) -> anyhow::Result<Drawn> {
        let p = self.p;
        let steady = || p.runs.iter().flat_map(|r| &r.fit.channels).map(|c| &c.channel);
        let channels = || steady().chain(p.transient_runs.iter().flat_map(TransientRun::channels));
        let excitation = channels().find(|c| c.quantity == Quantity::Force).map(|c| c.dof);
        let sensor = channels().filter(|c| c.quantity != Quantity::Force).map(|c| c.dof).next_back();
        let sensor = self.dof()?.or(sensor);
        let (Some(excitation), Some(sensor)) = (excitation, sensor) else { bail!("no run has a force and a motion") };
        let (omega, sources) = match self.outcome() {
            Ok(o) => (forward::frequencies(p, &o), forward::acting(p, &o)),
            Err(_) => (forward::frequencies_of_modes(p), forward::known(p)),
        };
        let response: ReceptanceCurve =
            forward::receptance(&p.structure, &sources, omega, [sensor, excitation], self.control)
                .map_err(anyhow::Error::msg)?;
        let quantity = self.arguments.quantity.quantity();
        let diagram = Diagram { project: p, response: &response, quantity };
        if self.arguments.what == PlotKind::Bode {
            return self.sheet(&diagram.title("Bode diagram"), diagram.bode_figures(self.palette).into());
        }
        let centre = p.runs[self.run()?].fit.omega;
        self.sheet(&diagram.title("Nyquist diagram"), vec![diagram.nyquist_figure(self.palette, centre)])
    }

    fn hysteresis(&self) -> anyhow::Result<Drawn> {
        let run = self.run()?;
        let loops = forward::run_loops(self.p, &self.outcome()?, run).map_err(anyhow::Error::msg)?;
        let figures = loops.iter().map(|l| l.figure(self.palette)).collect();
        self.sheet(&format!("Hysteresis of run {}", run + 1), figures)
    }

    /// The loop of one record of a component, else of the first that is used, with that of the known sources.
    fn component_loop(&self) -> anyhow::Result<Drawn> {
        let p = self.p;
        let loops = Loops::new(&p.structure, &p.sources, &p.transient_runs)?;
        let found = compare_component(&loops, &[])?;
        let index = self.arguments.run.unwrap_or(found.records[0].index + 1);
        let one = loops.list.iter().zip(&found.records).find(|(_, r)| r.index + 1 == index);
        let none = || format!("--run {index}: there is no such record, or it is switched off");
        let (one, record) = one.with_context(none)?;
        let model = record.model.first().context("the record has no force")?;
        self.figure(component_loops::figure(self.palette, one, model))
    }

    /// Index in the fit of the channel that was asked for, else of the first that is a motion.
    fn channel_index(&self, run: usize) -> anyhow::Result<usize> {
        let channels = &self.p.runs[run].fit.channels;
        let names = || channels.iter().map(|c| c.channel.to_string()).collect::<Vec<_>>().join(", ");
        let found = match &self.arguments.channel {
            Some(name) => channels.iter().position(|c| c.channel.to_string() == *name),
            None => channels.iter().position(|c| c.channel.quantity != Quantity::Force),
        };
        found.with_context(|| format!("run {} has no such channel; it has {}", run + 1, names()))
    }

    fn record(&self) -> anyhow::Result<Drawn> {
        let run = self.run()?;
        let r = &self.p.runs[run];
        let fit = &r.fit.channels[self.channel_index(run)?];
        let none = || format!("run {} came without a time record", run + 1);
        let record = r.record.as_ref().with_context(none)?;
        let found: Trace = trace(record, fit, r.fit.omega, self.control).with_context(none)?;
        let rotation = self.p.structure.dofs().get(fit.channel.dof).is_some_and(|d| d.direction.is_rotation());
        let axis = words::axis(fit.channel.quantity, rotation);
        let title = format!("{}, run {}", fit.channel, run + 1);
        if self.arguments.what == PlotKind::Record {
            let plot = RecordPlot { trace: &found, fit: &found.fit, omega: r.fit.omega, axis, id: &title };
            return self.sheet(&title, plot.figures(self.palette).into_iter().map(|f| f.0).collect());
        }
        let unit = axis.rsplit(", ").next().unwrap_or_default();
        let lines = found.spectrum.as_ref().context("the record is too short for a spectrum")?;
        self.sheet(&title, vec![spectrum::figure(self.palette, lines, &found.fit, r.fit.omega, unit)])
    }

    /// A record that is not steady against the model.
    fn unsteady(&self) -> anyhow::Result<Drawn> {
        let found = compared_with_records(self.p, self.control)?;
        let found = found.context("there is no model with matrices and no decay or transient that is used")?;
        let index = self.records().index()?;
        let run = &self.p.transient_runs[index];
        let off = || format!("{} is switched off", run.file);
        let record = found.records.iter().find(|record| record.index == index).with_context(off)?;
        if self.arguments.what == PlotKind::Amplitude {
            return self.amplitude(record, &run.file);
        }
        let name = self.arguments.channel.as_deref();
        let residual = RecordResidual::new(&self.p.structure, run, record, name);
        let residual = residual.with_context(|| format!("--channel {}: {} has none", name.unwrap_or(""), run.file))?;
        let title = residual.title();
        match self.arguments.what {
            PlotKind::Record => self.sheet(&title, residual.over_time(self.palette)),
            PlotKind::Spectrum => {
                let spectra = residual.spectra(self.palette);
                self.sheet(&title, vec![spectra.context("the record is too short for a spectrum")?])
            }
            _ => {
                let found = residual.spectrogram().context("the record is too short for a spectrogram")?;
                let [width, height] = self.arguments.size.map_or([900.0, 480.0], |[w, h]| [w as f32, h as f32]);
                let drawing = found.draw(emath::vec2(width, height), &format!("Left of {title}"), self.palette);
                Ok(Drawn { drawing, table: found.table() })
            }
        }
    }

    /// Damping ratio and frequency over amplitude of every mode that stands out of a record.
    fn amplitude(&self, record: &OneRecord, file: &str) -> anyhow::Result<Drawn> {
        let curves = amplitude_curve::told(&record.curves);
        let first = curves.first().context("no mode stands out of this record long enough")?;
        self.sheet(&format!("{}, {file}", first.channel), amplitude_curve::figures(&curves, self.palette))
    }

    fn error_map(&self) -> anyhow::Result<Drawn> {
        let found = self.comparison()?;
        let grid = Grid::new(&found, false);
        let most = grid.cells.iter().flatten().flatten().map(|c| c.error).fold(0.0, f64::max);
        let drawing = grid.draw(&Scale::new(found.noise_floor, most), "Error map, channels by runs", self.palette);
        Ok(Drawn { drawing, table: grid.table() })
    }

    /// Measured on modelled: one channel over frequency, over level, over a period, or as a loop.
    fn channel(&self) -> anyhow::Result<Drawn> {
        let (p, run) = (self.p, self.run()?);
        let index = self.channel_index(run)?;
        let name = p.runs[run].fit.channels[index].channel.to_string();
        let found = self.comparison()?;
        let now =
            samples::channel(&found, run, &name).with_context(|| format!("{name} is not compared in this run"))?;
        let fit = &p.runs[run].fit;
        let rotation = p.structure.dofs().get(now.dof).is_some_and(|d| d.direction.is_rotation());
        let cycle = Cycle { run, fit, now, trial: None, quantity: fit.channels[index].channel.quantity, rotation };
        let list = samples::samples(p, &found, None, &name);
        let near = response_curve::neighbourhood(p, run).map(|n| n.0).unwrap_or_default();
        let curves = if self.arguments.what == PlotKind::Channel {
            response_curve::curves(p, &[], run, self.control).map_err(anyhow::Error::msg)?
        } else {
            Vec::new()
        };
        let response = ChannelResponse {
            name: &name,
            samples: &list,
            run,
            levels: &response_curve::levels(p, &near),
            channel: index,
            unit: samples::unit(p, run, &name),
            curves: &curves,
            trial: &[],
        };
        let plain = |figures: Vec<(Figure, f32)>| figures.into_iter().map(|f| f.0).collect();
        match self.arguments.what {
            PlotKind::Period => self.sheet(&cycle.title("one period"), vec![cycle.time(self.palette)]),
            PlotKind::Loop => {
                let figure = cycle.hysteresis(self.palette).context("the run has no force channel")?;
                self.sheet(&cycle.title("loop"), vec![figure])
            }
            PlotKind::Level => {
                let figures = response.over_level(self.palette).context("at this frequency there is one level only")?;
                self.sheet(&response.title("level"), plain(figures))
            }
            _ => self.sheet(&response.title("frequency"), plain(response.over_frequency(self.palette))),
        }
    }
}
