//! Labels of degrees of freedom as project files write them.

/// A label as files write it: a whole number where it is one.
pub(super) fn label(label: String) -> toml_edit::Value {
    match label.parse::<i64>() {
        Ok(number) if number.to_string() == label => number.into(),
        _ => label.into(),
    }
}
