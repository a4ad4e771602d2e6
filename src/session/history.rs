//! Labelled undo and redo, one entry a gesture.

/// Marks the commands of one drag, so that they are undone together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Gesture(pub u64);

#[derive(Debug, Clone)]
struct Entry<T> {
    label: String,
    gesture: Option<Gesture>,
    /// The state on the other side of the entry: before it in the past, after it in the future.
    state: T,
}

/// Earlier and later states of a document. States are cheap to clone (shared).
#[derive(Debug, Clone)]
pub struct History<T> {
    past: Vec<Entry<T>>,
    future: Vec<Entry<T>>,
}

impl<T> Default for History<T> {
    fn default() -> Self {
        Self { past: Vec::new(), future: Vec::new() }
    }
}

impl<T> History<T> {
    /// Remembers that `before` was left by an action. An action of the gesture that is going on joins it; any action
    /// forgets what was undone.
    pub fn record(&mut self, label: String, gesture: Option<Gesture>, before: T) {
        let joins =
            gesture.is_some() && self.future.is_empty() && self.past.last().is_some_and(|e| e.gesture == gesture);
        self.future.clear();
        if !joins {
            self.past.push(Entry { label, gesture, state: before });
        }
    }

    /// Exchanges `current` with the state before the last action and returns that action's label.
    pub fn undo(&mut self, current: &mut T) -> Option<String> {
        Self::step(&mut self.past, &mut self.future, current)
    }

    /// Exchanges `current` with the state after the next action and returns that action's label.
    pub fn redo(&mut self, current: &mut T) -> Option<String> {
        Self::step(&mut self.future, &mut self.past, current)
    }

    fn step(from: &mut Vec<Entry<T>>, to: &mut Vec<Entry<T>>, current: &mut T) -> Option<String> {
        let Entry { label, state, .. } = from.pop()?;
        // A gesture ends where it is undone or redone: what follows is an action of its own.
        to.push(Entry { label: label.clone(), gesture: None, state: std::mem::replace(current, state) });
        Some(label)
    }

    /// Label of what [`History::undo`] would undo.
    pub fn undo_label(&self) -> Option<&str> {
        self.past.last().map(|entry| entry.label.as_str())
    }

    /// Label of what [`History::redo`] would redo.
    pub fn redo_label(&self) -> Option<&str> {
        self.future.last().map(|entry| entry.label.as_str())
    }

    /// Number of actions that can be undone.
    pub fn len(&self) -> usize {
        self.past.len()
    }

    /// Whether there is nothing to undo.
    pub fn is_empty(&self) -> bool {
        self.past.is_empty()
    }
}
