//! Dirty state, autosave and recovery, recent files.

use crate::support::BEAM;
use dashpot::session::recent::{MOST_RECENT, Recent};
use dashpot::session::save::autosave_path;
use dashpot::session::{Command, Session};

fn title(text: &str) -> Command {
    Command::SetTitle(text.into())
}

#[test]
fn what_a_crash_left_is_recovered_and_saving_forgets_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("project.toml");
    std::fs::write(&path, BEAM).unwrap();
    let mut session = Session::open(&path).unwrap();
    assert!(!session.is_dirty() && !session.autosave().unwrap());
    session.apply(&title("changed")).unwrap();
    assert!(session.is_dirty() && session.autosave().unwrap());
    assert!(!session.autosave().unwrap(), "nothing new to keep");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), BEAM);
    drop(session);

    let mut session = Session::open(&path).unwrap();
    assert!(session.recover().unwrap());
    assert_eq!(session.document().file().project.title, "changed");
    assert_eq!(session.history().undo_label(), Some("recover unsaved changes"));
    session.save().unwrap();
    assert!(!session.is_dirty() && !autosave_path(&path).exists());
    session.undo();
    assert!(session.is_dirty());
    session.redo();
    assert!(!session.is_dirty());
    assert!(!Session::open(&path).unwrap().recover().unwrap());
}

#[test]
fn a_save_that_fails_leaves_the_file_and_stays_dirty() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("project.toml");
    std::fs::write(&path, BEAM).unwrap();
    let mut session = Session::open(&path).unwrap();
    session.apply(&title("changed")).unwrap();
    let error = session.save_as(&folder.path().join("absent/project.toml")).unwrap_err();
    assert!(error.to_string().contains("absent"), "{error}");
    assert!(session.is_dirty() && session.path() == Some(path.as_path()));
}

#[test]
fn saved_in_another_folder_it_names_the_same_records() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("project.toml");
    std::fs::write(&path, format!("{BEAM}\n[[run]]\nfile = \"data/run-01.csv\"\n")).unwrap();
    let other = folder.path().join("copies");
    std::fs::create_dir(&other).unwrap();
    let mut session = Session::open(&path).unwrap();
    session.apply(&title("copy")).unwrap();
    session.save_as(&other.join("copy.toml")).unwrap();
    let named = || Session::open(&other.join("copy.toml")).unwrap().document().file().run.last().unwrap().file.clone();
    assert_eq!(named(), "../data/run-01.csv");
    assert!(!session.is_dirty());
    session.undo();
    session.save().unwrap();
    assert_eq!(named(), "../data/run-01.csv", "undo and save go on with the new folder");
    session.save_as(&path).unwrap();
    assert_eq!(Session::open(&path).unwrap().document().file().run.last().unwrap().file, "data/run-01.csv");
}

#[test]
fn what_is_saved_keeps_the_comments_of_the_file_under_both_names() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("project.toml");
    let text = format!("# measured on Monday\n{BEAM}\n# not yet known\n[[ruled_out]]\nlaw = \"coulomb\"\ndofs = [3]\n");
    std::fs::write(&path, &text).unwrap();
    let mut session = Session::open(&path).unwrap();
    session.apply(&title("changed")).unwrap();
    session.save().unwrap();
    let saved = std::fs::read_to_string(&path).unwrap();
    assert!(saved.starts_with("# measured on Monday\n") && saved.contains("title = \"changed\""), "{saved}");
    let differ = text.lines().zip(saved.lines()).filter(|(a, b)| a != b).count();
    assert!(differ == 1 && text.lines().count() == saved.lines().count(), "only the title is another:\n{saved}");
    let other = folder.path().join("copy.toml");
    session.save_as(&other).unwrap();
    assert_eq!(std::fs::read_to_string(&other).unwrap(), saved);
}

#[test]
fn a_damaged_autosave_is_no_harm() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("project.toml");
    std::fs::write(&path, BEAM).unwrap();
    std::fs::write(autosave_path(&path), "[project]\nformat = ").unwrap();
    assert!(!Session::open(&path).unwrap().recover().unwrap());
}

#[test]
fn recent_files_are_few_and_newest_first() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("config/recent.json");
    let mut recent = Recent::load(&store);
    for number in 0..20 {
        recent.add(&folder.path().join(format!("{number}.toml"))).unwrap();
    }
    recent.add(&folder.path().join("15.toml")).unwrap();
    let read = Recent::load(&store);
    assert_eq!(read, recent);
    assert_eq!(read.files().len(), MOST_RECENT);
    assert!(read.files()[0].ends_with("15.toml") && read.files()[1].ends_with("19.toml"));
    std::fs::write(&store, "not JSON").unwrap();
    assert!(Recent::load(&store).files().is_empty());
}

/// Two windows on one project: the one that saves later does not take back what the other has saved.
#[test]
fn what_another_window_saved_meanwhile_is_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("project.toml");
    std::fs::write(&path, format!("# Of the laboratory\n{BEAM}")).unwrap();
    let (mut one, mut other) = (Session::open(&path).unwrap(), Session::open(&path).unwrap());
    one.apply(&title("first")).unwrap();
    one.save().unwrap();
    one.apply(&title("first again")).unwrap();
    one.save().unwrap();

    other.apply(&title("second")).unwrap();
    let refused = other.save().unwrap_err().to_string();
    assert!(refused.contains("changed by another window") && refused.contains("another name"), "{refused}");
    assert!(!refused.contains('\n') && other.is_dirty());
    assert_eq!(Session::open(&path).unwrap().document().file().project.title, "first again");
    // Nothing of it is lost: it is saved under another name, and from there on by itself.
    let own = folder.path().join("second.toml");
    other.save_as(&own).unwrap();
    other.apply(&title("second again")).unwrap();
    other.save().unwrap();
    assert_eq!(Session::open(&own).unwrap().document().file().project.title, "second again");
    // Another comment, written with an editor, is no other project: it is kept.
    let text = std::fs::read_to_string(&path).unwrap().replace("Of the laboratory", "Of the other laboratory");
    std::fs::write(&path, text).unwrap();
    one.apply(&title("third")).unwrap();
    one.save().unwrap();
    assert!(std::fs::read_to_string(&path).unwrap().contains("# Of the other laboratory"));
}

#[test]
fn a_file_that_vanished_is_written_anew() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("project.toml");
    std::fs::write(&path, BEAM).unwrap();
    let mut session = Session::open(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    session.apply(&title("kept")).unwrap();
    session.save().unwrap();
    assert_eq!(Session::open(&path).unwrap().document().file().project.title, "kept");
    // With its folder gone it says so, and what is unsaved stays.
    std::fs::remove_dir_all(folder.path()).unwrap();
    session.apply(&title("unsaved")).unwrap();
    let refused = session.save().unwrap_err().to_string();
    assert!(refused.contains("check the folder and its free space"), "{refused}");
    assert!(session.is_dirty());
}

/// A clock that was set back or forth, or a network drive with a clock of its own: what was not saved is told by what the files hold,
/// not by when they were written.
#[test]
fn a_clock_that_jumps_loses_nothing() {
    let day = std::time::Duration::from_hours(24);
    let now = std::time::SystemTime::now();
    let jumps = [[now + 400 * day, now - 400 * day], [now - 4000 * day, now + 4000 * day], [now, now]];
    for [of_project, of_autosave] in jumps {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("project.toml");
        std::fs::write(&path, BEAM).unwrap();
        let mut session = Session::open(&path).unwrap();
        session.apply(&title("changed")).unwrap();
        session.autosave().unwrap();
        drop(session);
        let written = |path: &std::path::Path, at| {
            std::fs::File::options().append(true).open(path).unwrap().set_modified(at).unwrap();
        };
        written(&path, of_project);
        written(&autosave_path(&path), of_autosave);
        let mut session = Session::open(&path).unwrap();
        assert!(session.recover().unwrap(), "{of_project:?} {of_autosave:?}");
        assert_eq!(session.document().file().project.title, "changed");
        session.save().unwrap();
        assert!(!autosave_path(&path).exists());
        // Nor is a file taken for another's because its time is another.
        written(&path, of_autosave);
        session.apply(&title("changed again")).unwrap();
        session.save().unwrap();
        assert_eq!(Session::open(&path).unwrap().document().file().project.title, "changed again");
    }
}
