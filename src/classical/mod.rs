//! The methods that stood before the energy balance (chapter 3), side by side: one file a method, each opening with its
//! equations, what it needs and where it fails.
//!
//! Three families. *One degree of freedom*: [`log_decrement`], [`half_power`], [`circle_fit`], [`hysteresis_loop`],
//! [`energy_single`] give damping ratios. *Full receptance*: [`chen`], [`lee_kim`], [`instrumental`], [`fritzen`],
//! [`phani_woodhouse`] need the response of every DOF, most of them to a force at every DOF. *Complex modes*:
//! [`lancaster`], [`pilkey_inman`], [`ibrahim`], [`minas_inman`], [`adhikari_woodhouse`], [`frf_inverse`].
//! [`liang`] balances the energy of every DOF.
//!
//! `responses` takes the lines of the runs, [`poly_reference`] or `resonant` the complex modes from them, and
//! [`side_by_side`] applies every method that the data allow. [`measured_ratios`]
//! gives ratios with deviations, for use beside the energies. [`errors`] measures them against a known truth (3.117, 3.132-3.135);
//! [`incompleteness`] draws them against the number of modes and sensors.

pub mod adhikari_woodhouse;
pub mod chen;
pub mod circle_fit;
pub(crate) mod data;
pub mod energy_single;
pub(crate) mod error;
pub mod errors;
pub mod extracted_mode;
pub mod frf_inverse;
pub mod fritzen;
pub mod half_power;
pub mod hysteresis_loop;
pub mod ibrahim;
pub mod incompleteness;
pub mod instrumental;
mod isolated;
pub mod lancaster;
pub mod lee_kim;
pub mod liang;
mod linear;
pub mod log_decrement;
pub mod measured_ratios;
pub mod method;
pub mod minas_inman;
mod neighbours;
mod normal_sums;
pub mod phani_woodhouse;
mod phases;
pub mod pilkey_inman;
pub mod poly_reference;
mod ratios;
pub(crate) mod reference_shapes;
mod refine;
pub(crate) mod resonant;
pub(crate) mod responses;
pub mod side_by_side;
mod whole_responses;

pub use data::{Damping, DecayRecord, LoadCase, ModalData, ReceptanceData};
pub use error::ClassicalError;
pub use responses::FrequencyResponses;
