//! Writes a changed project into the text that it was read from: what did not change stays as it stands there, with its
//! comments, its order and its way of writing numbers.
//!
//! Both projects are written out in full; where the two differ, the text is changed at that key. Tables of a list that are
//! in both (longest common subsequence) stay; of those between them, one that was there for one that is new is changed.

use super::file::ProjectFile;
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, TableLike};

/// The text with what differs between `old`, which it holds, and `new`. `None` where the text cannot be changed so that it
/// holds `new`, such as one that is not TOML.
pub(crate) fn rewritten(text: &str, old: &ProjectFile, new: &ProjectFile) -> Option<String> {
    let mut document: DocumentMut = text.parse().ok()?;
    let in_full = |file: &ProjectFile| file.to_toml().ok()?.parse::<DocumentMut>().ok();
    let (before, after) = (in_full(old)?, in_full(new)?);
    change_table(document.as_table_mut(), before.as_table(), after.as_table());
    let text = document.to_string();
    let holds = ProjectFile::parse(&text, "").ok()?.0;
    (holds == *new).then_some(text)
}

fn change_table(there: &mut dyn TableLike, before: &dyn TableLike, after: &dyn TableLike) {
    for (key, _) in before.iter().filter(|(key, _)| !after.contains_key(key)) {
        there.remove(key);
    }
    for (key, item) in after.iter() {
        let old = before.get(key);
        if old.is_some_and(|old| said(old) == said(item)) {
            continue;
        }
        match (there.get_mut(key), old) {
            (Some(there), Some(old)) => change_item(there, old, item),
            _ => {
                there.insert(key, written_anew(item));
            }
        }
    }
}

fn change_item(there: &mut Item, before: &Item, after: &Item) {
    if let (Some(old), Some(new)) = (before.as_array_of_tables(), after.as_array_of_tables())
        && let Some(list) = there.as_array_of_tables_mut().filter(|list| list.len() == old.len())
    {
        change_list(list, old, new);
    } else if let (Some(old), Some(new)) = (before.as_table_like(), after.as_table_like())
        && let Some(table) = there.as_table_like_mut()
    {
        change_table(table, old, new);
    } else if let (Some(old), Some(new)) = (before.as_array(), after.as_array())
        && let Some(list) = there.as_array_mut().filter(|list| list.len() == old.len() && old.len() == new.len())
    {
        change_array(list, old, new);
    } else if let (Some(value), Some(new)) = (there.as_value_mut(), after.as_value()) {
        change_value(value, new);
    } else {
        *there = written_anew(after);
    }
}

fn change_array(there: &mut Array, before: &Array, after: &Array) {
    for (value, (old, new)) in there.iter_mut().zip(before.iter().zip(after)) {
        if literal(old) != literal(new) {
            change_value(value, new);
        }
    }
}

/// Another value between the blanks and comments of the old one.
fn change_value(there: &mut toml_edit::Value, new: &toml_edit::Value) {
    let decor = there.decor().clone();
    *there = new.clone();
    *there.decor_mut() = decor;
}

fn change_list(there: &mut ArrayOfTables, before: &ArrayOfTables, after: &ArrayOfTables) {
    let words = |list: &ArrayOfTables| list.iter().map(said_in).collect::<Vec<_>>();
    let tables: Vec<Table> = there.iter().cloned().collect();
    let [old, new]: [Vec<&Table>; 2] = [before, after].map(|list| list.iter().collect());
    there.clear();
    let mut next = 0;
    let (mut kept, ends) = (common(&words(before), &words(after)), (old.len(), new.len()));
    kept.push(ends);
    let mut free = 0;
    for (k, l) in kept {
        for (place, table) in new.iter().enumerate().take(l).skip(next) {
            // A table between two that stay takes the place of one that was there.
            let changed = (free < k).then(|| tables[free].clone());
            there.push(match changed {
                Some(mut changed) => {
                    change_table(&mut changed, old[free], new[place]);
                    changed
                }
                None => table_anew(table),
            });
            free += 1;
        }
        if (k, l) != ends {
            there.push(tables[k].clone());
        }
        (free, next) = (k + 1, l + 1);
    }
}

/// Places in both lists of their longest common subsequence.
fn common(old: &[String], new: &[String]) -> Vec<(usize, usize)> {
    let mut length = vec![vec![0_usize; new.len() + 1]; old.len() + 1];
    for i in (0..old.len()).rev() {
        for j in (0..new.len()).rev() {
            length[i][j] =
                if old[i] == new[j] { length[i + 1][j + 1] + 1 } else { length[i + 1][j].max(length[i][j + 1]) };
        }
    }
    let (mut i, mut j, mut found) = (0, 0, Vec::new());
    while i < old.len() && j < new.len() {
        if old[i] == new[j] {
            found.push((i, j));
            (i, j) = (i + 1, j + 1);
        } else if length[i + 1][j] >= length[i][j + 1] {
            i += 1;
        } else {
            j += 1;
        }
    }
    found
}

/// What an item of a project that is written out in full says, to be compared with another.
fn said(item: &Item) -> String {
    match item {
        Item::None => String::new(),
        Item::Value(value) => literal(value),
        Item::Table(table) => said_in(table),
        Item::ArrayOfTables(list) => list.iter().map(said_in).collect(),
    }
}

fn said_in(table: &Table) -> String {
    table.iter().map(|(key, item)| format!("{key} = {{{}}}\n", said(item))).collect()
}

/// A value without the blanks around it.
fn literal(value: &toml_edit::Value) -> String {
    value.to_string().trim().to_owned()
}

/// An item that has no place in a document yet: it is written behind what is there.
fn written_anew(item: &Item) -> Item {
    match item {
        Item::Table(table) => Item::Table(table_anew(table)),
        Item::ArrayOfTables(list) => Item::ArrayOfTables(list.iter().map(table_anew).collect()),
        other => other.clone(),
    }
}

fn table_anew(table: &Table) -> Table {
    let mut anew = Table::new();
    anew.set_implicit(table.is_implicit());
    for (key, item) in table {
        anew.insert(key, written_anew(item));
    }
    anew
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::effects::{Effect, State};
    use crate::exchange::project::file::SourceTable;
    use crate::exchange::project::label::Label;

    const TEXT: &str = "# A chain on the bench.\n[project]\nformat = 1\ntitle = \"t\"   # as tested\n\n[structure]\n\
        kind = \"chain\"\nmasses = [1, 2.50] # kg, weighed\nground_stiffness = [1e2, 0.0]\ncoupling_stiffness = [50]\n\n\
        # the damper of the catalogue\n[[source]]\nlaw = \"viscous\"\ndofs = [2, 1]\nstate = \"known\"\nc = 2 # N s/m\n\n\
        # dry\n[[source]]\nlaw = \"coulomb\"\ndofs = [2]\nforce = 1e-1\nstate = \"known\"\n\n\
        [[run]]\nfile = \"a.csv\" # slow\n";

    fn parsed(text: &str) -> ProjectFile {
        ProjectFile::parse(text, "p.toml").unwrap().0
    }

    fn dashpot() -> SourceTable {
        SourceTable {
            law: Effect::Viscous,
            dofs: vec![Label("1".to_owned())],
            elements: None,
            state: State::Known,
            parameters: [("c".to_owned(), 0.5)].into(),
        }
    }

    #[test]
    fn nothing_changes_where_nothing_was_changed() {
        let file = parsed(TEXT);
        assert_eq!(rewritten(TEXT, &file, &file).unwrap(), TEXT);
    }

    #[test]
    fn only_what_was_changed_is_written_and_all_comments_stay() {
        let old = parsed(TEXT);
        let mut new = old.clone();
        new.source[0].parameters.insert("c".to_owned(), 2.5);
        new.source.push(dashpot());
        let text = rewritten(TEXT, &old, &new).unwrap();
        let expected = TEXT.replace("c = 2 #", "c = 2.5 #");
        let (before, after) = expected.split_once("\n[[run]]").unwrap();
        assert!(text.starts_with(before), "{text}");
        assert!(text.ends_with(after), "{text}");
        assert_eq!(parsed(&text), new);
    }

    #[test]
    fn what_is_taken_out_takes_its_comment_along_and_leaves_the_others() {
        let old = parsed(TEXT);
        let mut new = old.clone();
        new.source.remove(0);
        let text = rewritten(TEXT, &old, &new).unwrap();
        assert!(!text.contains("catalogue") && text.contains("# dry") && text.contains("# kg, weighed"), "{text}");
        new.source.insert(0, dashpot());
        let text = rewritten(TEXT, &old, &new).unwrap();
        assert!(text.contains("# dry") && text.contains("force = 1e-1"), "{text}");
        assert_eq!(parsed(&text), new);
    }

    #[test]
    fn text_that_does_not_hold_the_old_project_is_not_changed_into_another() {
        let old = parsed(TEXT);
        let mut new = old.clone();
        new.project.title = "u".to_owned();
        assert!(rewritten(&TEXT.replace("2.50", "3.0"), &old, &new).is_none());
        assert!(rewritten("[project", &old, &new).is_none());
    }
}
