//! A base that moves, in the mapping.

use super::{dashpot, json};
use std::path::Path;

const BEAM: &str = "[project]\nformat = 1\n[structure]\nkind = \"beam\"\nlength = 0.56\nbreadth = 0.04\ndepth = 0.004\n\
    youngs_modulus = 69e9\ndensity = 2700.0\nelements = 5\nsupports = \"clamped-free\"\n\
    [[source]]\nlaw = \"viscous\"\ndofs = [9]\nstate = \"known\"\nc = 0.2\n";

#[test]
fn the_base_of_a_mapping_drives_the_model_as_that_of_a_record_does() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let runs = "[[run]]\nfile = \"run.csv\"\nfrequency = 10.0\n";
    let simulated = format!(
        "{BEAM}{runs}base = \"z\"\nbase_m_s2 = 1.0\n[simulate]\nchannels = [\"base@z [m/s^2]\", \"acc@9 [m/s^2]\"]\n"
    );
    std::fs::write(path("truth.toml"), simulated).unwrap();
    let truth = path("truth.toml").display().to_string();
    dashpot(&["simulate", &truth, "--out", &folder.path().display().to_string()]).unwrap();
    let record = std::fs::read_to_string(path("run.csv")).unwrap();
    let renamed = record.replacen("base@z [m/s^2]", "Table [m/s^2]", 1).replacen("acc@9 [m/s^2]", "Tip [m/s^2]", 1);
    std::fs::write(path("lab.csv"), renamed).unwrap();
    let map = |place: &str| {
        format!(
            "[[channel]]\nname = \"Table\"\nquantity = \"base\"\n{place}\n[[channel]]\nname = \"Tip\"\nquantity = \"acc\"\ndof = 9\n"
        )
    };
    let error = |name: &str, text: &str| {
        std::fs::write(path(name), text).unwrap();
        json(&["compare", "--json", &path(name).display().to_string()])["error"].as_f64().unwrap()
    };
    let own = error("own.toml", &format!("{BEAM}{runs}"));
    let lab = runs.replace("run.csv", "lab.csv");
    assert!(own < 1e-6, "{own}");
    assert_eq!(error("mapped.toml", &format!("{BEAM}{}{lab}", map("direction = \"z\""))), own);
    assert_eq!(error("dof.toml", &format!("{BEAM}{}{lab}", map("dof = \"z\""))), own);
    let reversed = error("reversed.toml", &format!("{BEAM}{}{lab}", map("direction = \"z\"\nsign = -1")));
    assert!(reversed > 1.0, "{reversed}");
    refused(folder.path(), &format!("{BEAM}{}{lab}", map("direction = \"w\"")), "use one of \"x\", \"y\", \"z\"");
    refused(folder.path(), &format!("{BEAM}{}{lab}", map("")), "direction = \"z\"");
    refused(folder.path(), &format!("{BEAM}{}{lab}", map("direction = \"x\"")), "does not move along \"x\"");
}

fn refused(folder: &Path, text: &str, words: &str) {
    let file = folder.join("bad.toml");
    std::fs::write(&file, text).unwrap();
    let error = dashpot(&["compare", &file.display().to_string()]).unwrap_err();
    assert!(error.contains(words) && !error.contains('\n'), "{error}");
}
