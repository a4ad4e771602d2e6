//! The table of terms.

/// A term.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Term {
    /// Its name, as it stands in the window.
    pub name: &'static str,
    /// Other words that the window has for it, such as those of a narrow column.
    pub also: &'static [&'static str],
    /// What it is, in one or two sentences.
    pub meaning: &'static str,
}

const fn term(name: &'static str, also: &'static [&'static str], meaning: &'static str) -> Term {
    Term { name, also, meaning }
}

/// All terms, in the order in which the stages show them.
pub const TERMS: &[Term] = &[
    // Stages.
    term("Measure", &[], "First stage: the records, how well their harmonics are fitted, and what is wrong with them."),
    term(
        "Structure",
        &[],
        "Second stage: mass and stiffness, natural frequencies, mode shapes, and which degrees of freedom are measured.",
    ),
    term("Pattern", &[], "Third stage: where energy may be lost, drawn on the structure as candidate sources."),
    term("Select", &[], "Fourth stage: which of the candidates explain the measured energies, step by step."),
    term(
        "Result",
        &[],
        "Fifth stage: the identified damping matrix, energy shares, damping ratios, responses and loops.",
    ),
    term(
        "Explain",
        &[],
        "Sixth stage: where the model differs from the measurement, which effect it lacks, and how far the error falls with it.",
    ),
    // Panes.
    term(
        "Schematic",
        &[],
        "The structure with its degrees of freedom, sensors, exciters, supports and sources; what is clicked here is selected everywhere.",
    ),
    term("Inspector", &[], "The values of what is selected, with their units; those in fields can be changed."),
    term("Records over time", &[], "Records of tests that are not steady: ring-downs, hammer tests, sweeps, noise."),
    term(
        "Runs",
        &["Run"],
        "Tests in which the structure vibrated steadily at one frequency and one force, one record each.",
    ),
    term(
        "Record",
        &[],
        "The samples of one channel over time with the fitted harmonics on top and the residual under them.",
    ),
    term("Overview", &[], "Amplitude and phase of one channel over frequency for all runs, one curve a force level."),
    term("Spectrum", &[], "Amplitudes of one channel over frequency, with the harmonics that were fitted."),
    term(
        "Modes",
        &["Mode"],
        "Shapes in which the structure vibrates freely, each with its natural frequency; numbered from the lowest.",
    ),
    term(
        "Shape",
        &[],
        "How the measured points move together: a mode shape or an operating shape that another program found.",
    ),
    term(
        "Parameters",
        &[],
        "The numbers that mass and stiffness are made of; changing one computes everything that follows anew.",
    ),
    term("Frequencies", &[], "Natural frequencies of the model beside the frequencies of the runs."),
    term(
        "Mode shape",
        &[],
        "Relative displacement of every degree of freedom in the selected mode; measured ones stand out.",
    ),
    term(
        "Expansion",
        &["Expansion to the others"],
        "How the motion of degrees of freedom without a sensor is found from the measured ones and the model.",
    ),
    term(
        "Laws",
        &["Law"],
        "How a source's force follows from the motion there: viscous dashpot, Coulomb friction, hysteretic damping and others.",
    ),
    term(
        "Sources",
        &["Source", "Which"],
        "Places where energy may be lost (or stored), each with a law and a state; under them their coefficients.",
    ),
    term("Steps", &[], "The best set of sources for each number of sources, with its angle and errors."),
    term(
        "Set and alternatives",
        &["Alternatives"],
        "The sources of the step that is looked at, and other sets of the same size, next best first.",
    ),
    term(
        "Angle",
        &[],
        "Angle between the measured and the identified energies of all runs, seen as vectors: 0 where they agree, 90 degrees where nothing is explained.",
    ),
    term(
        "Energy per run",
        &[],
        "Energy that each run takes in a period: measured, and as the identified sources take it out.",
    ),
    term(
        "Damping matrix",
        &["Matrix"],
        "Forces at the rows for unit velocities at the columns, of the identified sources.",
    ),
    term("Values", &[], "Everything identified as a table that can be copied."),
    term(
        "Energy",
        &["By source", "By degree of freedom"],
        "Share of the energy of all used runs that a source, or the sources at a degree of freedom, take out; all shares are 100 %.",
    ),
    term(
        "Damping",
        &["Damping ratios"],
        "Damping of every mode of the model with what was identified; View > Units chooses ratio, Q, loss factor or decrement.",
    ),
    term(
        "Bode",
        &[],
        "Magnitude and phase of the frequency response over frequency: the model's curve and the measured points.",
    ),
    term(
        "Nyquist",
        &[],
        "Imaginary over real part of the frequency response near the selected run; a resonance is nearly a circle.",
    ),
    term("Hysteresis", &[], "Force over displacement in one period; the area of the loop is the energy lost in it."),
    term(
        "Methods",
        &["Method"],
        "The classical methods of damping identification on the same data, side by side with their needs and limits.",
    ),
    term(
        "Incompleteness",
        &["Along", "Error of"],
        "What the classical methods lose when fewer modes or fewer sensors are measured.",
    ),
    term(
        "Change",
        &[],
        "Two states of a structure held against each other: which sources and damping ratios changed by more than noise makes.",
    ),
    term(
        "Error map",
        &[],
        "Error of the model for every run (columns) and channel (rows); dark is worse, white is within the noise.",
    ),
    term(
        "Measured and modelled",
        &[],
        "The cell of the error map that is selected: measured points on the model's curve, along frequency, level, time or as a loop.",
    ),
    term(
        "What is missing?",
        &[],
        "Effects that the model may lack, ranked by probability, each with its evidence; Try previews one, Add puts it into the model.",
    ),
    term("Corrections", &[], "What else of the model, the channels and the runs the data correct, with deviations."),
    term(
        "Ledger",
        &["Changes so far"],
        "Every model that was looked at with its error; a click goes back to it, none is lost.",
    ),
    // Measure.
    term("Use", &[], "Whether the run takes part in the analysis; all results follow when it is ticked or not."),
    term("File", &[], "File of the record, beside the project."),
    term("Frequency", &[], "Frequency of the run at which its harmonics are fitted, or natural frequency of a mode."),
    term(
        "Fit frequency",
        &[],
        "Frequency at which the harmonics are fitted, as stated in the project or estimated from the record.",
    ),
    term(
        "Level",
        &["Force level"],
        "Number of the force level: runs of different levels tell effects that depend on amplitude.",
    ),
    term(
        "Noise",
        &["Noise over signal"],
        "Noise over signal: residual of the fit over the measured signal, root mean square over the channels.",
    ),
    term(
        "Harmonics",
        &[],
        "Largest higher harmonic over the fundamental, over all motions: distortion, a sign of nonlinear effects.",
    ),
    term("Harmonic", &[], "Multiple of the frequency of the run; 1 is the fundamental."),
    term(
        "Flags",
        &["What is wrong"],
        "What is doubtful about a record, in words; a flagged run is used all the same until it is unticked.",
    ),
    term("Period", &[], "Duration of one cycle of the excitation."),
    term("Periods", &[], "Number of cycles in the record; some ten make the noise small."),
    term("Duration", &[], "Length of the record."),
    term("Samples per channel", &[], "Number of samples of each channel of the record."),
    term("Amplitude", &[], "Peak value of a harmonic, not root mean square."),
    term(
        "Phase",
        &[],
        "Angle by which a harmonic leads the cosine of the run's time axis, or the response leads the force.",
    ),
    // Structure.
    term(
        "Degrees of freedom",
        &["DOF", "DOFs", "Node", "Nodes"],
        "Displacements and rotations that describe the motion; their labels stand beside the nodes of the schematic.",
    ),
    term("Nearest run", &[], "The run whose frequency is nearest to that of the mode."),
    term(
        "Run − mode",
        &[],
        "Difference between the frequency of the nearest run and that of the mode, relative to the mode's.",
    ),
    term(
        "Measured DOFs",
        &[],
        "Degrees of freedom that carry a sensor; the motion of the others is expanded from them.",
    ),
    term(
        "Model error it allows for",
        &[],
        "Relative error of mass and stiffness that the expansion reckons with, found from how well it fits the sensors.",
    ),
    term("At sensors", &[], "Measured minus expanded motion at the sensors, relative to the measured."),
    term(
        "In deviations",
        &[],
        "Measured minus expanded motion at the sensors in standard deviations of the noise: about 1 where the model agrees.",
    ),
    term("At other DOFs", &[], "Expected relative error of the expanded motion over all degrees of freedom."),
    term("Ends, left and right", &[], "How the ends of the beam are held: clamped, pinned or free."),
    term("Young's modulus", &[], "Stiffness of the material: stress over strain."),
    term(
        "Depth, in the direction of bending",
        &["Depth"],
        "Height of the cross-section in the direction in which the beam bends.",
    ),
    term("Breadth", &[], "Width of the cross-section across the direction in which the beam bends."),
    term("Elements", &[], "Number of finite elements along the beam."),
    term(
        "Lumped masses",
        &[],
        "Rigid masses at degrees of freedom beside that of the structure, such as those of sensors.",
    ),
    term("Mass on the diagonal", &[], "Entry of the mass matrix of this degree of freedom."),
    term("Stiffness on the diagonal", &[], "Entry of the stiffness matrix of this degree of freedom."),
    term(
        "Moving mass",
        &[],
        "Mass that moves with the sensor of force of the testing machine; its force of inertia is taken off.",
    ),
    // Analysis.
    term("Harmonics fitted", &[], "Number of harmonics that are fitted to every channel of every run."),
    term("Sources at most", &[], "Largest number of sources that the selection tries."),
    term("Sets kept (0: all)", &[], "How many of the sets of one size go on to the next step; 0 tries all."),
    term("Stop angle", &[], "Angle below which the selection takes the energies for explained and stops."),
    term("Weights", &[], "How much each run counts: by its energy, by its noise, or all the same."),
    // Sources.
    term(
        "Place",
        &[],
        "Where a source acts: between a degree of freedom and the ground, between two of them, or along a chain.",
    ),
    term(
        "State",
        &[],
        "Candidate: may be selected. Forced: always selected. Known: acts with the value given. Off: left out. Reference: only compared with.",
    ),
    term("Coefficient", &["Coefficients"], "The number that was identified for a source, with one standard deviation."),
    term(
        "Energy error",
        &[],
        "Distance of the identified energies of all runs from the measured ones, relative to these.",
    ),
    term(
        "\u{3c7}² per row",
        &[],
        "Squared deviations of the energies over their variance, per run: about 1 where the set explains the data to their noise.",
    ),
    term(
        "Half-power",
        &[],
        "Damping from the width of the model's own resonance at its half-power points, where it has both: how the usual estimate would read it.",
    ),
    term(
        "Damping ratio ζ",
        &["Damping ratio", "ζ"],
        "Damping of a mode over that at which it would no longer oscillate; about half the loss factor.",
    ),
    term("Quality factor Q", &["Q"], "Frequency of a resonance over its width: 1 over twice the damping ratio."),
    term(
        "Loss factor η",
        &["η"],
        "Energy lost in a cycle over 2 pi times the energy stored: about twice the damping ratio.",
    ),
    term(
        "Log. decrement δ",
        &["Logarithmic decrement", "δ"],
        "Logarithm of the ratio of successive amplitudes of a free decay: about 2 pi times the damping ratio.",
    ),
    term("Receptance", &[], "Displacement over force, as a function of frequency."),
    term("Mobility", &[], "Velocity over force, as a function of frequency."),
    term("Accelerance", &[], "Acceleration over force, as a function of frequency."),
    // Methods and change.
    term("Error C", &[], "Distance of the damping matrix from the reference, relative to it, per cent."),
    term(
        "MAC error",
        &[],
        "Largest deviation of the modes from those of the reference by the modal assurance criterion.",
    ),
    term("First", &[], "Value in the earlier state, with its deviation where there is room."),
    term("Second", &[], "Value in the later state, with its deviation where there is room."),
    term("Difference", &[], "Later less earlier value with its standard deviation."),
    term("Chance", &[], "Probability of a difference as large by noise alone; below 1 % the change is taken for real."),
    // Explain.
    term(
        "Error",
        &[],
        "Root mean square of measured less modelled amplitudes over all channels and runs, relative to the measured.",
    ),
    term("Noise floor", &["noise floor"], "The error that an exact model would have: what noise alone makes."),
    term(
        "Left-out runs",
        &["left-out runs"],
        "Error for runs that were left out of the fit: a model that only follows the noise is worse there.",
    ),
    term(
        "Probability",
        &["probability"],
        "Probability of a suggestion among all that were tried, from how well it explains the data and how many parameters it takes.",
    ),
    term(
        "Fingerprint",
        &[],
        "How the equivalent damping or stiffness at the place goes with amplitude or frequency; the slope tells the law.",
    ),
    term(
        "Next test",
        &[],
        "The run that would tell most: between suggestions that cannot be told apart, or about the least certain number.",
    ),
    term(
        "The model is detuned",
        &[],
        "Mass, stiffness or known damping differ from the structure's: corrected in the search, and in the project if you want it.",
    ),
    term("Deviation", &["±"], "One standard deviation: the true value lies within it in two of three cases."),
    // Import.
    term("Channel", &[], "A column of a record: what one sensor measured."),
    term(
        "Quantity",
        &[],
        "What a channel measures: force, acceleration, velocity, displacement or the motion of the base.",
    ),
    term("Sense", &[], "+ along the direction of the degree of freedom, − against it."),
    term("Unit", &[], "Unit of the numbers; in an import where the file says none or a wrong one."),
    term("Factor", &[], "Calibration: units a number of the file."),
    term("Delay, ms", &["Delay"], "How late the channel is recorded."),
    term(
        "Averages",
        &[],
        "Number of averages of a frequency response; with the coherence they give the deviation of every value.",
    ),
    term("Point in the file", &[], "Node and direction as the measuring system names them."),
];
