//! Clauses of codes, and how far their values could be checked.
//!
//! The standards themselves were not available. Every value that is printed therefore states how it was checked.

/// How a value of a code was checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Evidence {
    /// A published calculation, guide or digest of the standard quotes the value with its clause.
    Quoted,
    /// A public program by other authors uses the value with its clause.
    Used,
    /// No such source confirms the value.
    Memory,
    /// The value follows from mechanics.
    Derived,
    /// The input gives the value.
    Given,
}

impl Evidence {
    /// The words that are printed beside a value.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Evidence::Quoted => "quoted in published calculations",
            Evidence::Used => "used by a public program",
            Evidence::Memory => "from memory",
            Evidence::Derived => "mechanics",
            Evidence::Given => "given in the input",
        }
    }
}

/// A clause of one edition of a code, with the check of its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CodeClause {
    /// The standard, such as `EN 1991-3:2006`.
    pub standard: &'static str,
    /// Its edition.
    pub edition: &'static str,
    /// The clause or table.
    pub clause: &'static str,
    /// How the value was checked.
    pub evidence: Evidence,
}

/// Name of EN 1991-3 in printed values.
pub const EN_1991_3: &str = "EN 1991-3:2006";
/// Name of EN 1993-6 in printed values.
pub const EN_1993_6: &str = "EN 1993-6:2007";
/// Name of CMAA 70 in printed values.
pub const CMAA_70: &str = "CMAA 70";
/// Name of AIST Technical Report 13 in printed values.
pub const AIST_TR_13: &str = "AIST TR-13";

/// A clause of EN 1991-3:2006.
#[must_use]
pub const fn en_1991_3(clause: &'static str, evidence: Evidence) -> CodeClause {
    CodeClause {
        standard: EN_1991_3,
        edition: "2006",
        clause,
        evidence,
    }
}

/// A clause of EN 1993-6:2007.
#[must_use]
pub const fn en_1993_6(clause: &'static str, evidence: Evidence) -> CodeClause {
    CodeClause {
        standard: EN_1993_6,
        edition: "2007",
        clause,
        evidence,
    }
}

/// A clause of the edition of 2010 of CMAA 70.
#[must_use]
pub const fn cmaa_2010(clause: &'static str, evidence: Evidence) -> CodeClause {
    CodeClause {
        standard: CMAA_70,
        edition: "2010",
        clause,
        evidence,
    }
}

/// A clause of the edition of 1983 of CMAA 70.
#[must_use]
pub const fn cmaa_1983(clause: &'static str, evidence: Evidence) -> CodeClause {
    CodeClause {
        standard: CMAA_70,
        edition: "1983",
        clause,
        evidence,
    }
}

/// A clause of AIST Technical Report 13, edition of 2021.
#[must_use]
pub const fn aist_2021(clause: &'static str, evidence: Evidence) -> CodeClause {
    CodeClause {
        standard: AIST_TR_13,
        edition: "2021",
        clause,
        evidence,
    }
}

/// A clause of AIST Technical Report 13, draft of 2020.
#[must_use]
pub const fn aist_2020(clause: &'static str, evidence: Evidence) -> CodeClause {
    CodeClause {
        standard: AIST_TR_13,
        edition: "draft of 2020",
        clause,
        evidence,
    }
}

/// A clause of ASCE/SEI 7-16, which ASCE/SEI 7-22 repeats.
#[must_use]
pub const fn asce_7(clause: &'static str, evidence: Evidence) -> CodeClause {
    CodeClause {
        standard: "ASCE/SEI 7",
        edition: "2016",
        clause,
        evidence,
    }
}

/// A clause of 29 CFR 1910.179 (OSHA).
#[must_use]
pub const fn osha(clause: &'static str) -> CodeClause {
    CodeClause {
        standard: "29 CFR 1910.179",
        edition: "current",
        clause,
        evidence: Evidence::Quoted,
    }
}

/// FEM 1.001, booklet 2, 2.2.3.3.
pub const FEM_SKEW: CodeClause = CodeClause {
    standard: "FEM 1.001",
    edition: "1998",
    clause: "booklet 2, 2.2.3.3",
    evidence: Evidence::Used,
};

/// A limit of one's own.
pub const OWN_LIMIT: CodeClause = CodeClause {
    standard: "own limit",
    edition: "",
    clause: "practice.limits",
    evidence: Evidence::Given,
};

/// A value that follows from `principle` and from no code.
#[must_use]
pub const fn mechanics(principle: &'static str) -> CodeClause {
    CodeClause {
        standard: "mechanics",
        edition: "",
        clause: principle,
        evidence: Evidence::Derived,
    }
}
