//! Roles of the cards that do not define the structure: which of them are left out, and why others are refused.

/// Why a card that does not define the structure may be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CardRole {
    /// It is left out with a warning: loads, solution and output requests.
    Request,
    /// It is left out with a warning: properties and materials, which have no effect without the elements that use them,
    /// and materials of heat transfer, which have none beside the MAT1 of members.
    Property,
    /// It cannot change the stiffness of the structure, and is left out where the user asks for this.
    NoStiffness,
}

/// Loads, requests of solutions and output, and tables.
const REQUESTS: &[&str] = &[
    "PARAM", "DEBUG", "FORCE", "FORCE1", "FORCE2", "MOMENT", "MOMENT1", "MOMENT2", "LOAD", "PLOAD",
    "PLOAD1", "PLOAD2", "PLOAD4", "PLOADX1", "SLOAD", "GRAV", "RFORCE", "ACCEL", "ACCEL1", "TEMP",
    "TEMPD", "TEMPRB", "TEMPP1", "DAREA", "DLOAD", "DELAY", "DPHASE", "RLOAD1", "RLOAD2", "TLOAD1",
    "TLOAD2", "LSEQ", "TABLED1", "TABLED2", "TABLED3", "TABLED4", "TABLEM1", "TABDMP1", "TABRND1",
    "RANDPS", "EIGR", "EIGRL", "EIGC", "EIGB", "FREQ", "FREQ1", "FREQ2", "FREQ3", "FREQ4", "TSTEP",
    "TSTEPNL", "NLPARM", "NLPCI", "ASET", "ASET1", "OMIT", "OMIT1", "USET", "USET1", "SET1",
    "SET3", "PLOTEL", "SEQGP", "CBARAO", "ECHOON", "ECHOOFF", "DCONADD", "MATT1",
];

/// Properties and materials of elements that cannot be imported, and materials of heat transfer.
const PROPERTIES: &[&str] = &[
    "PSHELL", "PSOLID", "PCOMP", "PCOMPG", "PSHEAR", "PBUSH", "PGAP", "PMASS", "MAT2", "MAT8",
    "MAT9", "MAT10", "MAT4", "MAT5", "MATT4", "MATT5",
];

/// Cards of optimisation, aeroelasticity, heat transfer, damping, dynamics, nonlinear solutions and output, more
/// loads, and masses: nothing of them is part of the linear static stiffness.
const NO_STIFFNESS: &[&str] = &[
    // optimisation
    "DESVAR", "DVPREL1", "DVPREL2", "DVMREL1", "DVMREL2", "DVCREL1", "DVCREL2", "DVGRID", "DRESP1",
    "DRESP2", "DRESP3", "DCONSTR", "DOPTPRM", "DSCREEN", "DLINK", "DEQATN", "DTABLE", "DDVAL",
    "POPT", "PLIMIT", "TOPVAR", "DMNCON", // aeroelasticity
    "AERO", "AEROS", "AESTAT", "AESURF", "AESURFS", "AELIST", "AEFACT", "AELINK", "AEPARM",
    "AECOMP", "AECOMPL", "AEPRESS", "AEFORCE", "CAERO1", "CAERO2", "CAERO3", "CAERO4", "CAERO5",
    "CAERO7", "PAERO1", "PAERO2", "PAERO3", "PAERO4", "PAERO5", "SPLINE1", "SPLINE2", "SPLINE3",
    "SPLINE4", "SPLINE5", "SPLINE6", "SPLINE7", "SET2", "TRIM", "TRIMFLT", "TRIMVAR", "TRIMFNC",
    "DIVERG", "CSSCHD", "FLUTTER", "FLFACT", "MKAERO1", "MKAERO2", "MKAEROZ", "GUST", "MONPNT1",
    "MONPNT2", "MONPNT3", "MONDSP1", "PANLST1", "PANLST2", "PANLST3", "PAFOIL7", "AEROZ", "ACOORD",
    "BODY7", "SEGMESH", "FIXMACH", "PLTAERO", "PLTMODE", "PLTVG", "PLTTRIM",
    "PLTFLUT", // heat transfer and temperature
    "MATT2", "MATT8", "MATT9", "CHBDY", "CHBDYE", "CHBDYG", "CHBDYP", "PHBDY", "CONV", "CONVM",
    "PCONV", "PCONVM", "RADM", "RADMT", "RADBC", "RADSET", "RADCAV", "RADLST", "RADMTX", "VIEW",
    "VIEW3D", "QBDY1", "QBDY2", "QBDY3", "QHBDY", "QVECT", "QVOL", "TEMPBC", "TEMPN1", "TEMPG",
    "TEMPP2", "TEMPP3", "TEMPAX", "TEMPRB1", // damping, mass and dynamics
    "CDAMP1", "CDAMP2", "CDAMP3", "CDAMP4", "CDAMP5", "PDAMP", "PDAMP5", "CVISC", "PVISC",
    "DAMPING", "CMASS1", "CMASS2", "CMASS3", "CMASS4", "CONM1", "TIC", "TF", "NOLIN1", "NOLIN2",
    "NOLIN3", "NOLIN4", "TSTEP1", "TABDMP2", "RANDT1", "RANDT2", "RANDVAR", "ACSRCE", "EIGP",
    "ROTORG", "ROTORD", "RSPINR", "RSPINT", "ROTORSE", "UNBALNC", // nonlinear solutions
    "MATS1", "MATHP", "TABLES1", "TABLEST", "NLCNTL", "NLCNTL2", "NLADAPT", "CREEP", "BOLTFOR",
    "BOLT", // loads
    "SPCD", "SPCR", "DEFORM", "PLOADX", "PRESPT", "PRESAX", "CLOAD", "LOADCYN", "LOADMOD",
    "RFORCE1", "SLOADN1", // tables, partitions, output and free bodies
    "TABLEM2", "TABLEM3", "TABLEM4", "TABLED5", "TABRNDG", "TABLEH1", "TABLEHT", "TABLE3D",
    "SUPORT", "SUPORT1", "SUPAX", "BSET", "BSET1", "CSET", "CSET1", "QSET", "QSET1", "SETMC",
    "PLOTEL3", "PLOTEL4", "PLOTEL6", "PLOTEL8", "POINT", "PTADD", "OUTPUT", "OUTRCV", "ADAPT",
    "DTI", "DMI", "YPARAM", "EXTFILE", "MDLPRM", "STFLOW", "PVAL", "PSET", "SEQEP", "OMITCFD",
    "INPCFD", "LIST", "VARIAN", "GENGAF", "ASE", "SPOINT", "EPOINT", "MLDSTAT", "MLDTRIM",
    "CONCT1", "BARPARM", // properties without the elements that use them
    "PBUSH1D", "PBUSHT", "PELAST", "PDAMPT", "PFAST", "PWELD", "PLPLANE", "PLSOLID", "PTRMEM",
    "PQDMEM", "PQDMEM1", "PQDMEM2", "PTRPLT", "PQUAD1", "PQUAD2", "PTRIA1", "PTRIA2", "PTRIA6",
    "PINTS", "PRAC2D", "PRAC3D", "PACABS", "PCONEAX", "MAT3", "MAT11", "MATG", "MATTG",
];

/// The role of a card; `None` if it may be part of the structure, or is not known.
#[must_use]
pub fn role(name: &str) -> Option<CardRole> {
    if REQUESTS.contains(&name) {
        Some(CardRole::Request)
    } else if PROPERTIES.contains(&name) {
        Some(CardRole::Property)
    } else {
        NO_STIFFNESS
            .contains(&name)
            .then_some(CardRole::NoStiffness)
    }
}

/// Whether a card is an element that is not a member.
#[must_use]
pub fn is_other_element(name: &str) -> bool {
    let is_member = matches!(name, "CBAR" | "CBEAM" | "CROD" | "CTUBE" | "CONROD");
    name.starts_with('C') && !name.starts_with("CORD") && !is_member && role(name).is_none()
}

/// Whether a card that may be left out has mass, so that its omission changes natural frequencies and inertia.
#[must_use]
pub fn has_mass(name: &str) -> bool {
    matches!(name, "CONM1" | "CMASS1" | "CMASS2" | "CMASS3" | "CMASS4")
}

/// Advice for a card that is refused: what the reader supports instead.
#[must_use]
pub fn advice(name: &str) -> &'static str {
    match name {
        "MPC" | "MPCADD" | "RBE1" | "RBE3" | "RROD" | "RJOINT" | "RTRPLT" | "CRIGDR" | "CRIGD1"
        | "CRIGD2" | "CRIGD3" => "supported rigid links are RBE2 and RBAR",
        "CBUSH" | "CBUSH1D" | "CELAS3" | "CELAS4" | "GENEL" => {
            "supported springs are CELAS1 and CELAS2"
        }
        "CONM1" | "CMASS1" | "CMASS2" => "supported masses are CONM2",
        "SPCOFF" | "SPCOFF1" => "supported restraints are SPC and SPC1",
        "CBEND" | "CBEAM3" | "CBAR3" | "CELBOW" => {
            "supported members are CBAR, CBEAM, CROD, CTUBE and CONROD"
        }
        "PBCOMP" | "PBMSECT" | "PBRSECT" | "PBEND" => {
            "supported properties are PBAR, PBARL, PBEAM and PBEAML"
        }
        "DMIG" => "direct matrix input is not supported",
        _ if name.starts_with('C') => {
            "a beam spec consists of members, rigid links, masses and springs to ground"
        }
        _ => "this card is unknown",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_card_has_one_role() {
        let lists = [REQUESTS, PROPERTIES, NO_STIFFNESS];
        let mut all: Vec<&str> = lists.into_iter().flatten().copied().collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
        for stiff in [
            "CBAR", "CBUSH", "CQUAD4", "CSHEAR", "RBE3", "MPC", "CELAS3", "GENEL", "DMIG", "SPC",
            "CGAP",
        ] {
            assert_eq!(role(stiff), None, "{stiff}");
        }
    }
}
