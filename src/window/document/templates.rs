//! New projects: small structures whose numbers are then made one's own.

/// A template.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Template {
    /// Name in the menu.
    pub name: &'static str,
    /// Text of the project file.
    pub text: &'static str,
}

/// All templates.
pub(crate) const ALL: [Template; 3] = [
    Template {
        name: "Beam",
        text: "[project]\nformat = 1\ntitle = \"New beam\"\n[structure]\nkind = \"beam\"\nlength = 1.0\nbreadth = 0.04\n\
               depth = 0.005\nyoungs_modulus = 2.1e11\ndensity = 7850.0\nelements = 10\nsupports = \"clamped-free\"\n\
               [[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n",
    },
    Template {
        name: "Chain of masses",
        text: "[project]\nformat = 1\ntitle = \"New chain\"\n[structure]\nkind = \"chain\"\n\
               masses = [1.0, 1.0, 1.0, 1.0, 1.0]\nground_stiffness = [1e4, 0.0, 0.0, 0.0, 0.0]\n\
               coupling_stiffness = [1e4, 1e4, 1e4, 1e4]\n\
               [[candidates]]\nlaw = \"viscous\"\nwhere = \"each-pair\"\n",
    },
    Template {
        name: "Points without a model",
        text: "[project]\nformat = 1\ntitle = \"New points\"\n[structure]\nkind = \"points\"\ndofs = [1, 2, 3, 4, 5]\n\
               [[candidates]]\nlaw = \"viscous\"\nwhere = \"each-pair\"\n",
    },
];

#[cfg(test)]
mod tests {
    use super::ALL;
    use crate::window::document::Document;

    #[test]
    fn every_template_is_a_project() {
        for template in ALL {
            let document = Document::new(template.text);
            assert!(document.is_ok_and(|d| !d.project.sources.is_empty()), "{}", template.name);
        }
    }
}
