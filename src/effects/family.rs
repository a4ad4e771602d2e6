//! Families of candidates: each translation, each DOF, each pair, one chain.
