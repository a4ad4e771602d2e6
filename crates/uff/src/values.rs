//! Many numbers, real or complex.

/// Values of a function or a shape.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Real ones.
    Real(Vec<f64>),
    /// Complex ones, `[re, im]`.
    Complex(Vec<[f64; 2]>),
}

impl Values {
    /// How many there are; a complex value is one.
    pub fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Complex(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether they are complex.
    pub fn is_complex(&self) -> bool {
        matches!(self, Self::Complex(_))
    }

    /// Value number `i` as `[re, im]`; a real one has no imaginary part.
    pub fn get(&self, i: usize) -> Option<[f64; 2]> {
        match self {
            Self::Real(values) => values.get(i).map(|&re| [re, 0.0]),
            Self::Complex(values) => values.get(i).copied(),
        }
    }

    /// Numbers in the order of the file; an odd one at the end of complex values is left out.
    pub(crate) fn from_numbers(numbers: Vec<f64>, complex: bool) -> Self {
        if complex {
            Self::Complex(numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
        } else {
            Self::Real(numbers)
        }
    }

    /// The numbers of values `from..to`, real and imaginary parts in turn.
    pub(crate) fn numbers(&self, from: usize, to: usize) -> Vec<f64> {
        match self {
            Self::Real(values) => values[from..to].to_vec(),
            Self::Complex(values) => values[from..to].iter().flatten().copied().collect(),
        }
    }
}
