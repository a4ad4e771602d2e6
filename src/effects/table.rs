//! The table of laws: one line each. The line names the variant of [`super::Effect`], the family in which the law is written,
//! and its file in `laws`, which is also its name in project files.

/// Hands the table to a macro.
macro_rules! table_of_laws {
    ($then:ident) => {
        $then! {
            Viscous: Linear = viscous,
            Coulomb: Memoryless = coulomb,
            Quadratic: Memoryless = quadratic,
            Power: Memoryless = power,
            Hysteretic: Linear = hysteretic,
            Stribeck: Memoryless = stribeck,
            ElasticSlider: Masing = elastic_slider,
            Maxwell: Linear = maxwell,
            Iwan: Masing = iwan,
            Fractional: Linear = fractional,
            BoucWen: Internal = bouc_wen,
            StiffeningBoucWen: Internal = stiffening_bouc_wen,
            Dahl: Internal = dahl,
            ElasticSliderBacklash: Internal = elastic_slider_backlash,
            AsymmetricViscous: Memoryless = asymmetric_viscous,
            AsymmetricCoulomb: Memoryless = asymmetric_coulomb,
            Stiffness: Linear = stiffness,
            CubicStiffness: Memoryless = cubic_stiffness,
            QuadraticStiffness: Memoryless = quadratic_stiffness,
            Gap: Memoryless = gap,
            Stop: Memoryless = stop,
            Mass: Linear = mass,
            LossFactor: Whole = loss_factor,
            StiffnessProportional: Whole = stiffness_proportional,
            MassProportional: Whole = mass_proportional,
            Delay: Channel = delay,
            Gain: Channel = gain,
        }
    };
}

pub(super) use table_of_laws;
