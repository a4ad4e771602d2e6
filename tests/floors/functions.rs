//! Functions are short: what is long does several things, each of which deserves a name.

/// Lines of a function from its name to its last brace: half of all functions at most.
const MEDIAN: usize = 8;
/// The same of nine functions in ten.
const NINTH_TENTH: usize = 24;
/// The same of any function.
const MOST: usize = 90;

/// Name and length of every function of a text.
fn functions(text: &str) -> Vec<(String, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (start, line) in lines.iter().enumerate() {
        let Some(name) = name(line) else { continue };
        let indent = &line[..line.len() - line.trim_start().len()];
        let Some(open) = (start..lines.len()).find(|&k| lines[k].trim_end().ends_with(['{', '}', ';'])) else {
            continue;
        };
        let length = match lines[open].trim_end().chars().last() {
            // A method of a trait without a body.
            Some(';') => continue,
            Some('}') => open - start + 1,
            _ => {
                let closing = format!("{indent}}}");
                let end = (open + 1..lines.len()).find(|&k| lines[k].starts_with(&closing)).unwrap_or(open);
                end - start + 1
            }
        };
        found.push((name.to_owned(), length));
    }
    found
}

/// The name of the function that a line begins.
fn name(line: &str) -> Option<&str> {
    let mut rest = line.trim_start();
    if let Some(public) = rest.strip_prefix("pub") {
        rest = public.strip_prefix('(').map_or(public, |scope| scope.split_once(')').map_or(scope, |(_, after)| after));
    }
    for word in ["const ", "async "] {
        rest = rest.trim_start();
        rest = rest.strip_prefix(word).unwrap_or(rest);
    }
    let rest = rest.trim_start().strip_prefix("fn ")?;
    Some(&rest[..rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len())])
}

#[test]
fn functions_are_short() {
    let mut all: Vec<(usize, String)> = Vec::new();
    for source in super::sources() {
        let text = source.text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        let named = |(name, length)| (length, format!("{} {name}: {length} lines", source.path.display()));
        all.extend(functions(text).into_iter().map(named));
    }
    all.sort();
    let share = |tenths: usize| all[all.len() * tenths / 10].0;
    let worst: Vec<&str> = all.iter().rev().take(20).map(|(_, said)| said.as_str()).collect();
    let said = worst.join("\n");
    assert!(share(5) <= MEDIAN, "half of the functions have more than {MEDIAN} lines; the longest:\n{said}");
    assert!(
        share(9) <= NINTH_TENTH,
        "{} of {} functions have more than {NINTH_TENTH} lines, more than a tenth; the longest:\n{said}",
        all.iter().filter(|(length, _)| *length > NINTH_TENTH).count(),
        all.len()
    );
    assert!(all[all.len() - 1].0 <= MOST, "at most {MOST} lines; the longest:\n{said}");
}

#[test]
fn functions_are_measured_as_they_stand() {
    let text = "impl A {\n    pub(super) fn one(&self) -> f64 {\n        1.0\n    }\n\n    fn asked();\n}\n\nconst fn two() {}\n";
    assert_eq!(functions(text), [("one".to_owned(), 3), ("two".to_owned(), 1)]);
}
