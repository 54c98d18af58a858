//! The papers whose machine and systems the emulator runs.

/// Given name or initials, and family name.
pub(super) type Name = (&'static str, &'static str);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Technical report; [`Work::venue`] is the institution.
    Report,
    /// Paper of a conference; [`Work::venue`] is the conference.
    Paper,
}

#[derive(Debug)]
pub(super) struct Work {
    /// Short name in the documents of the project, which is also the key in BibTeX.
    pub(super) key: &'static str,
    pub(super) systems: &'static str,
    pub(super) kind: Kind,
    pub(super) authors: &'static [Name],
    pub(super) title: &'static str,
    pub(super) venue: &'static str,
    pub(super) number: Option<&'static str>,
    pub(super) year: u16,
    pub(super) pages: Option<[u16; 2]>,
    pub(super) doi: Option<&'static str>,
}

const UNC: &str = "University of North Carolina at Chapel Hill";

/// All cited papers. docs/sources.md lists these papers and all other sources of the project.
pub(super) const WORKS: &[Work] = &[
    Work {
        key: "F89",
        systems: "The machine Pixel-Planes 5",
        kind: Kind::Paper,
        authors: &[
            ("Henry", "Fuchs"),
            ("John", "Poulton"),
            ("John", "Eyles"),
            ("Trey", "Greer"),
            ("Jack", "Goldfeather"),
            ("David", "Ellsworth"),
            ("Steve", "Molnar"),
            ("Greg", "Turk"),
            ("Brice", "Tebbs"),
            ("Laura", "Israel"),
        ],
        title: "Pixel-Planes 5: a heterogeneous multiprocessor graphics system using processor-enhanced memories",
        venue: "SIGGRAPH 89",
        number: None,
        year: 1989,
        pages: Some([79, 88]),
        doi: Some("10.1145/74333.74341"),
    },
    Work {
        key: "TR94",
        systems: "Rendering Control and Slats",
        kind: Kind::Report,
        authors: &[("Jonathan", "Cohen"), ("Marc", "Olano")],
        title: "Low Latency Rendering on Pixel-Planes 5",
        venue: UNC,
        number: Some("TR94-028"),
        year: 1994,
        pages: None,
        doi: None,
    },
    Work {
        key: "I3D95",
        systems: "Slats and the measurement from outside",
        kind: Kind::Paper,
        authors: &[("Marc", "Olano"), ("Jonathan", "Cohen"), ("Mark", "Mine"), ("Gary", "Bishop")],
        title: "Combatting Rendering Latency",
        venue: "Symposium on Interactive 3D Graphics",
        number: None,
        year: 1995,
        pages: Some([19, 24]),
        doi: Some("10.1145/199404.199407"),
    },
    Work {
        key: "JITP",
        systems: "Just-in-time pixels",
        kind: Kind::Report,
        authors: &[("Mark", "Mine"), ("Gary", "Bishop")],
        title: "Just-In-Time Pixels",
        venue: UNC,
        number: Some("TR93-005"),
        year: 1993,
        pages: None,
        doi: None,
    },
    Work {
        key: "RP94",
        systems: "Priority rendering and address recalculation",
        kind: Kind::Paper,
        authors: &[("Matthew", "Regan"), ("Ronald", "Pose")],
        title: "Priority Rendering with a Virtual Reality Address Recalculation Pipeline",
        venue: "SIGGRAPH 94",
        number: None,
        year: 1994,
        pages: Some([155, 162]),
        doi: Some("10.1145/192161.192192"),
    },
    Work {
        key: "CPR05",
        systems: "Segmented scenes of priority rendering",
        kind: Kind::Paper,
        authors: &[("Yang-Wai", "Chow"), ("Ronald", "Pose"), ("Matthew", "Regan")],
        title: "Large Object Segmentation with Region Priority Rendering",
        venue: "Australasian Computer Science Conference",
        number: None,
        year: 2005,
        pages: None,
        doi: None,
    },
    Work {
        key: "SpatialGL",
        systems: "SpatialGL and the volumetric display",
        kind: Kind::Report,
        authors: &[("W.-S.", "Chun"), ("T. J.", "Purtell II"), ("O. S.", "Cossairt")],
        title: "Technical Introduction to the Basic SpatialGL Rendering Pipeline",
        venue: "Actuality Systems",
        number: Some("ASI-0110"),
        year: 2005,
        pages: None,
        doi: None,
    },
];
