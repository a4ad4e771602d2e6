//! The laws, one file each, as the table of laws (`table`) lists them.

use super::effect::Effect;
use super::internal::Internal;
use super::kind::Kind;
use super::linear::Linear;
use super::masing::Masing;
use super::memoryless::Memoryless;
use super::table::table_of_laws;

/// What a law of a family acts on.
macro_rules! kind {
    (Whole, $law:expr) => {
        Kind::Whole(&$law)
    };
    (Channel, $law:expr) => {
        Kind::Channel(&$law)
    };
    ($family:ident, $law:expr) => {
        Kind::Relative(&$family($law))
    };
}

macro_rules! laws {
    ($($effect:ident: $family:ident = $file:ident,)*) => {
        $(pub(crate) mod $file;)*

        impl Effect {
            /// The law behind the name.
            pub fn kind(self) -> Kind {
                match self {
                    $(Self::$effect => kind!($family, $file::$effect),)*
                }
            }
        }
    };
}

table_of_laws!(laws);
