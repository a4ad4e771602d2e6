//! What cannot be identified is said in one line.

use super::points::five_points;
use super::support::*;
use dashpot::balance::Expansion;
use dashpot::control::Control;
use dashpot::effects::{Effect, Source, State};
use dashpot::identify::{IdentifyError, Settings, identify};
use dashpot::measurement::{Quantity, Run};
use dashpot::structure::Structure;

fn runs() -> Vec<Run> {
    let truth = [source(Effect::Viscous, &[1], &[15.0])];
    Rig::near_modes(&five_masses(), 3, 1.01, 0, &[0, 1]).runs(&five_masses(), &truth)
}

fn error(structure: &Structure, sources: &[Source], runs: &[Run], settings: &Settings) -> String {
    identify(structure, sources, runs, settings, &Control::unattended()).unwrap_err().to_string()
}

#[test]
fn each_fault_is_one_clear_line() {
    let (chain, points, settings) = (five_masses(), five_points(), all_sets());
    let one = vec![candidate(Effect::Viscous, &[1])];
    let mut disabled = runs();
    for run in &mut disabled {
        run.enabled = false;
    }
    let mut forceless = runs();
    forceless[1].fit.channels.retain(|c| c.channel.quantity != Quantity::Force);
    let mut motionless = runs();
    motionless[2].fit.channels.retain(|c| c.channel.quantity == Quantity::Force);
    let mut undriven = runs();
    for run in &mut undriven {
        run.fit.channels.retain(|c| c.channel.dof != 0 || c.channel.quantity == Quantity::Force);
    }
    let mut forced: Vec<Source> = (0..4).map(|i| candidate(Effect::Viscous, &[i])).collect();
    for source in &mut forced {
        source.state = State::Forced;
    }
    let modal = Settings { expansion: Expansion::Modes, ..all_sets() };
    let cases = [
        (error(&chain, &one, &[], &settings), "no run to use"),
        (error(&chain, &one, &disabled, &settings), "no run to use"),
        (error(&chain, &[], &runs(), &settings), "no source to identify"),
        (error(&chain, &one, &forceless, &settings), "no force channel"),
        (error(&chain, &one, &motionless, &settings), "no acceleration, velocity or displacement channel"),
        (error(&points, &one, &undriven, &settings), "force@1 has no sensor"),
        (error(&chain, &forced, &runs(), &settings), "4 sources are forced but there are only 3 runs"),
        (error(&chain, &one, &runs(), &Settings { max_sources: 0, ..all_sets() }), "max_sources is 0"),
        (error(&points, &one, &runs(), &modal), "needs mass and stiffness"),
    ];
    for (message, part) in cases {
        assert!(message.contains(part) && !message.contains('\n'), "{message}");
    }
}

#[test]
fn a_negative_input_energy_is_not_explained() {
    let mut backwards = runs();
    for run in &mut backwards {
        run.fit.channels[0].amplitudes[0] *= -1.0;
    }
    let one = vec![candidate(Effect::Viscous, &[1])];
    let message = error(&five_masses(), &one, &backwards, &all_sets());
    assert!(message.contains("input energy is not positive"), "{message}");
}

#[test]
fn cancelling_stops_it() {
    let control = Control::unattended();
    control.cancel();
    let one = vec![candidate(Effect::Viscous, &[1])];
    let result = identify(&five_masses(), &one, &runs(), &all_sets(), &control);
    assert!(matches!(result, Err(IdentifyError::Cancelled(_))));
}
