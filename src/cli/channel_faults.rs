//! Faults of channels in `dashpot diagnose`, in words and as JSON.

use super::table::number;
use crate::diagnosis::channels::{ChannelFault, Fault};
use serde_json::{Map, Value, json};

/// What is said of runs that are lines of frequency responses.
pub(super) const NO_AMPLITUDE: &str =
    "frequency responses have no amplitude: laws whose force is not in proportion to the motion are not looked for";

/// As suggestions in the JSON document: a gain, or `exchanged` with `channels`.
pub(super) fn suggestions(faults: &[ChannelFault]) -> impl Iterator<Item = Value> + '_ {
    // A channel that is not to be relied on is no effect that could be added: it is told under `channel_faults`.
    let mendable = faults.iter().filter(|fault| !matches!(fault.fault, Fault::Unreliable(_)));
    mendable.map(|fault| {
        let mut map = Map::new();
        match fault.fault {
            Fault::Unreliable(_) => {}
            Fault::Factor(factor) => {
                map.insert("effect".into(), json!("gain"));
                map.insert("channel".into(), json!(fault.channels[0]));
                map.insert("parameters".into(), json!({ "gain": factor }));
                map.insert("standard_deviation".into(), json!({ "gain": null }));
            }
            Fault::Late(delay) => {
                map.insert("effect".into(), json!("delay"));
                map.insert("channel".into(), json!(fault.channels[0]));
                map.insert("parameters".into(), json!({ "delay": delay }));
                map.insert("standard_deviation".into(), json!({ "delay": null }));
            }
            Fault::Common(factor) => {
                map.insert("effect".into(), json!("gain"));
                map.insert("dofs".into(), json!([]));
                map.insert("channels".into(), json!(fault.channels));
                map.insert("parameters".into(), json!({ "gain": factor }));
                map.insert("standard_deviation".into(), json!({ "gain": null }));
            }
            Fault::Exchanged | Fault::Elsewhere(_) => {
                let kind = if fault.fault == Fault::Exchanged { "exchanged" } else { "elsewhere" };
                map.insert("effect".into(), json!(kind));
                map.insert("dofs".into(), json!([]));
                map.insert("channels".into(), json!(fault.channels));
                map.insert("parameters".into(), json!({}));
                map.insert("standard_deviation".into(), json!({}));
            }
        }
        map.insert("error_after".into(), json!(fault.error_after));
        map.insert("held_out_error_after".into(), json!(fault.error_after));
        map.insert("probability".into(), json!(1.0));
        map.insert("evidence".into(), json!([fault.words(), fault.evidence()]));
        map.insert("indistinguishable_from".into(), json!([]));
        Value::Object(map)
    })
}

/// A fault in the JSON document.
pub(super) fn document(fault: &ChannelFault) -> Value {
    let (kind, factor) = match fault.fault {
        Fault::Exchanged => ("exchanged", None),
        Fault::Elsewhere(_) => ("elsewhere", None),
        Fault::Unreliable(_) => ("unreliable", None),
        Fault::Late(_) => ("late", None),
        Fault::Factor(-1.0) | Fault::Common(-1.0) => ("reversed", Some(-1.0)),
        Fault::Factor(factor) | Fault::Common(factor) => ("factor", Some(factor)),
    };
    json!({
        "fault": kind,
        "channels": fault.channels,
        "factor": factor,
        "delay_s": if let Fault::Late(delay) = fault.fault { Some(delay) } else { None },
        "scatter": if let Fault::Unreliable(scatter) = fault.fault { Some(scatter) } else { None },
        "words": fault.words(),
        "error_before": fault.error_before,
        "error_after": fault.error_after,
        "own_error_before": fault.own_error[0],
        "own_error_after": fault.own_error[1],
    })
}

/// The faults in sentences.
pub(super) fn text(faults: &[ChannelFault]) -> String {
    if faults.is_empty() {
        return String::new();
    }
    let mut text = "\nchannels first; all that follows is with them mended\n".to_owned();
    for fault in faults {
        let [before, after] = [fault.error_before, fault.error_after].map(|error| number(100.0 * error));
        // A channel that scatters is not mended, only relied on less.
        let fall = match fault.fault {
            Fault::Unreliable(_) => String::new(),
            _ => format!(": error {before} % before, {after} % after"),
        };
        text.push_str(&format!("  {}{fall}\n", fault.words()));
        text.push_str(&format!("    {}\n", fault.evidence()));
    }
    text
}
