//! Files of tables to findings.
