//! Cell arrays with the names of their arrays among them, as tables are kept by hand: a column `name, unit, array` a channel, or a
//! row. MATLAB counts cells down the columns.
//!
//! ```text
//! 'Time'  'Force'  'Acc'          'Time'   's'  [700x1]
//! 's'     'N'      'g'            'Force'  'N'  [700x1]
//! [700x1] [700x1]  [700x1]        'Acc'    'g'  [700x1]
//! ```

use super::{Array, Entry, Node};
use crate::units::is_unit;

/// Most texts that belong to one array.
const MOST_TEXTS: usize = 4;

/// Most single numbers of a cell array that stand among its texts as words; where there are more they are measured.
const MOST_NUMBERS: usize = 256;

/// What a cell array holds: texts are a list of names, also with single numbers among them, as in a table of sensors.
pub(crate) fn of_cell(entries: Vec<Entry>) -> Node {
    let word = |entry: &Entry| match &entry.node {
        Node::Text(texts) => Some(texts.join(" ")),
        Node::Array(array) => array.scalar().map(|value| value.to_string()),
        Node::Group(_) | Node::Skipped(_) => None,
    };
    let words: Option<Vec<String>> = entries.iter().map(word).collect();
    let texts = entries.iter().filter(|entry| matches!(entry.node, Node::Text(_))).count();
    match words {
        Some(words) if texts > 0 && words.len() - texts <= MOST_NUMBERS => Node::Text(words),
        Some(words) if texts > 0 => Node::Skipped(format!(
            "its {} numbers stand one by one in a cell with texts; save them as an array (cell2mat of the cells with numbers)",
            words.len() - texts
        )),
        _ => Node::Group(named(entries)),
    }
}

/// The cells, or the arrays among them under their names and with their units, where every array has as many texts.
fn named(entries: Vec<Entry>) -> Vec<Entry> {
    let arrays = entries.iter().filter(|entry| array(entry).is_some()).count();
    let texts = entries.iter().filter(|entry| text(entry).is_some()).count();
    let each = texts.checked_div(arrays).unwrap_or(0);
    if arrays < 2 || !(1..=MOST_TEXTS).contains(&each) || arrays * (each + 1) != entries.len() {
        return entries;
    }
    // Place of field `field` of channel `channel`, by columns and by rows.
    let layouts: [&dyn Fn(usize, usize) -> usize; 2] =
        [&|channel, field| channel * (each + 1) + field, &|channel, field| field * arrays + channel];
    let fits = |place: &&&dyn Fn(usize, usize) -> usize| {
        let is_text = |channel: usize| (0..each).all(|field| text(&entries[place(channel, field)]).is_some());
        (0..arrays).all(|channel| is_text(channel) && array(&entries[place(channel, each)]).is_some())
    };
    let Some(place) = layouts.iter().find(fits) else { return entries };
    let channel = |channel: usize| {
        let mut entry = entries[place(channel, each)].clone();
        let words: Vec<&str> = (0..each).filter_map(|field| text(&entries[place(channel, field)])).collect();
        words[0].clone_into(&mut entry.name);
        entry
            .attributes
            .extend(words[1..].iter().find(|word| is_unit(word)).map(|unit| ("unit".to_owned(), (*unit).to_owned())));
        entry
    };
    (0..arrays).map(channel).collect()
}

/// A text that is one.
fn text(entry: &Entry) -> Option<&str> {
    match &entry.node {
        Node::Text(texts) if texts.len() == 1 => Some(texts[0].trim()),
        _ => None,
    }
}

/// An array of several numbers.
fn array(entry: &Entry) -> Option<&Array> {
    match &entry.node {
        Node::Array(array) if array.shape.len().is_some_and(|count| count > 1) => Some(array),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::Shape;
    use super::*;

    /// Names and units in the cells above arrays or in front of them are those of the arrays.
    #[test]
    fn cells_of_names_units_and_arrays_are_named_arrays() {
        let text = |word: &str| Entry::new("{}", Node::Text(vec![word.to_owned()]));
        let array = |id: usize| {
            Entry::new(
                "{}",
                Node::Array(Array { id, shape: Shape::new([9, 1], true), complex: false, peek: Vec::new() }),
            )
        };
        let told = |entries: Vec<Entry>| -> Vec<String> {
            named(entries)
                .iter()
                .map(|entry| format!("{} {:?}", entry.name, entry.attributes.first().map(|(_, unit)| unit)))
                .collect()
        };
        let by_columns = vec![text("Force"), text("N"), array(0), text("Acc"), text("g"), array(1)];
        let by_rows = vec![text("Force"), text("Acc"), text("N"), text("g"), array(0), array(1)];
        assert_eq!(told(by_columns), ["Force Some(\"N\")", "Acc Some(\"g\")"]);
        assert_eq!(told(by_rows), ["Force Some(\"N\")", "Acc Some(\"g\")"]);
        assert_eq!(told(vec![text("Force"), array(0), array(1)]), ["{} None", "{} None", "{} None"]);
    }

    #[test]
    fn cells_of_texts_and_numbers_are_lists_of_words() {
        let number = |value: f64| {
            let shape = Shape::new([1, 1], true);
            Entry::new("", Node::Array(Array { id: 0, shape, complex: false, peek: vec![[value, 0.0]] }))
        };
        let text = |word: &str| Entry::new("", Node::Text(vec![word.to_owned()]));
        let mixed = of_cell(vec![text("acc"), number(12.0), text("+Z"), number(0.5)]);
        assert!(matches!(&mixed, Node::Text(words) if words[..] == ["acc", "12", "+Z", "0.5"]), "{mixed:?}");
        assert!(matches!(of_cell(vec![number(1.0), number(2.0)]), Node::Group(_)));
        assert!(matches!(of_cell(Vec::new()), Node::Group(_)));
        let signal = [vec![text("t")], (0..300).map(|i| number(f64::from(i))).collect()].concat();
        let said = of_cell(signal);
        assert!(matches!(&said, Node::Skipped(why) if why.contains("300 numbers")), "{said:?}");
    }
}
