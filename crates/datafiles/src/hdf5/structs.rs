//! Arrays of structs in MATLAB 7.3: a group with a data set of references a field becomes a struct an element.

use crate::tree::{Entry, Node};

/// The elements of an array of structs, named `(1)`, `(2)` and so on; other groups as they are.
pub(super) fn elements(fields: Vec<Entry>) -> Vec<Entry> {
    let Some(count) = common_count(&fields) else { return fields };
    let of = |i: usize| {
        let field = |field: &Entry| Entry { name: field.name.clone(), ..element(field, i) };
        Entry::new(format!("({})", i + 1), Node::Group(fields.iter().map(field).collect()))
    };
    (0..count).map(of).collect()
}

/// Number of elements, the same in every field; none where a field is no list of them.
fn common_count(fields: &[Entry]) -> Option<usize> {
    let count = |field: &Entry| match &field.node {
        Node::Group(inner) => {
            let numbered = |(i, entry): (usize, &Entry)| entry.name == format!("({})", i + 1);
            inner.iter().enumerate().all(numbered).then_some(inner.len())
        }
        Node::Text(texts) => Some(texts.len()),
        Node::Array(_) | Node::Skipped(_) => None,
    };
    let first = fields.first().and_then(count).filter(|count| *count > 1)?;
    let lists = fields.iter().any(|field| matches!(field.node, Node::Group(_)));
    (lists && fields.iter().all(|field| count(field) == Some(first))).then_some(first)
}

fn element(field: &Entry, i: usize) -> Entry {
    match &field.node {
        Node::Group(inner) => inner[i].clone(),
        Node::Text(texts) => Entry::new("", Node::Text(vec![texts[i].clone()])),
        Node::Array(_) | Node::Skipped(_) => field.clone(),
    }
}
