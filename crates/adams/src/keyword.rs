//! Keywords of statements, identifiers, and how words are abbreviated.

use std::fmt;

macro_rules! keywords {
    ($($variant:ident $word:literal,)*) => {
        /// The kind of a statement.
        #[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Keyword {
            $(#[doc = $word] $variant,)*
            /// Any other word, in capitals.
            Other(String),
        }

        impl Keyword {
            /// Every keyword that the crate knows, with its word.
            pub const ALL: &'static [(Keyword, &'static str)] = &[$((Keyword::$variant, $word),)*];

            /// The full word in capitals.
            #[must_use]
            pub fn as_str(&self) -> &str {
                match self {
                    $(Keyword::$variant => $word,)*
                    Keyword::Other(word) => word,
                }
            }
        }
    };
}

keywords! {
    Accgrav "ACCGRAV",
    Array "ARRAY",
    Beam "BEAM",
    Bushing "BUSHING",
    Contact "CONTACT",
    Coupler "COUPLER",
    Curve "CURVE",
    Cvcv "CVCV",
    Debug "DEBUG",
    Diff "DIFF",
    Equilibrium "EQUILIBRIUM",
    Field "FIELD",
    FlexBody "FLEX_BODY",
    Friction "FRICTION",
    Gcon "GCON",
    Gear "GEAR",
    Gforce "GFORCE",
    Graphics "GRAPHICS",
    Gse "GSE",
    Ic "IC",
    Integrator "INTEGRATOR",
    Joint "JOINT",
    Jprim "JPRIM",
    Kinematics "KINEMATICS",
    List "LIST",
    Lse "LSE",
    Lsolver "LSOLVER",
    Marker "MARKER",
    Material "MATERIAL",
    Matrix "MATRIX",
    Mforce "MFORCE",
    Motion "MOTION",
    Nforce "NFORCE",
    Output "OUTPUT",
    Part "PART",
    Pinput "PINPUT",
    PointMass "POINT_MASS",
    Poutput "POUTPUT",
    Preferences "PREFERENCES",
    Ptcv "PTCV",
    Request "REQUEST",
    Results "RESULTS",
    Sensor "SENSOR",
    Sforce "SFORCE",
    Spline "SPLINE",
    Springdamper "SPRINGDAMPER",
    String "STRING",
    Surface "SURFACE",
    Tfsiso "TFSISO",
    Units "UNITS",
    Variable "VARIABLE",
    Vforce "VFORCE",
    Vtorque "VTORQUE",
}

impl From<&str> for Keyword {
    fn from(word: &str) -> Keyword {
        match Keyword::ALL.iter().find(|(_, known)| *known == word) {
            Some((keyword, _)) => keyword.clone(),
            None => Keyword::Other(word.to_owned()),
        }
    }
}

impl fmt::Display for Keyword {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// Which statement of a data set is meant; it is written `GFORCE/17`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StatementId {
    /// Kind of statement.
    pub keyword: Keyword,
    /// The identifier; zero for a statement that has none.
    pub id: u32,
}

impl StatementId {
    /// The statement `keyword/id`, its keyword given as a full word in capitals.
    #[must_use]
    pub fn new(keyword: &str, id: u32) -> StatementId {
        StatementId {
            keyword: Keyword::from(keyword),
            id,
        }
    }
}

impl fmt::Display for StatementId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.keyword, self.id)
    }
}

/// The item of `words` that `text` names in full or abbreviates, in any case.
///
/// A full name takes precedence over an abbreviation of a longer one. An abbreviation of several words names
/// none.
pub(crate) fn lookup<'a, T: Clone>(words: &'a [(T, &'a str)], text: &str) -> Option<T> {
    if let Some((item, _)) = words
        .iter()
        .find(|(_, word)| word.eq_ignore_ascii_case(text))
    {
        return Some(item.clone());
    }
    let begins = |word: &str| {
        word.get(..text.len())
            .is_some_and(|start| start.eq_ignore_ascii_case(text))
    };
    let mut found = words
        .iter()
        .filter(|(_, word)| !text.is_empty() && begins(word));
    match (found.next(), found.next()) {
        (Some((item, _)), None) => Some(item.clone()),
        _ => None,
    }
}
