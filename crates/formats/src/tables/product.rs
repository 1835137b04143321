//! G as a sum of products of one-curve tables.

use crate::block::GridBlock;

/// G(x, z) = sum of curve(x) curve(z): x is where the load stands, z where the deflection is taken.
///
/// Each curve is read as CUBSPL does, by the natural cubic spline.
#[derive(Clone, Debug, PartialEq)]
pub struct Product {
    /// Name of the plain table.
    pub name: String,
    /// Which deflection it relates to which load, where that is known.
    pub quantity: Option<GridBlock>,
    /// Rail of the deflection and rail of the load, where they are known.
    pub rails: Option<[String; 2]>,
    /// Numbers of the tables of a term: the one at x, the one at z.
    pub terms: Vec<[u32; 2]>,
}

impl Product {
    /// The expression, for a comment: `name(x,z) = CUBSPL(x,0,101)*CUBSPL(z,0,101) + ...`.
    #[must_use]
    pub fn expression(&self) -> String {
        let term = |[x, z]: &[u32; 2]| format!("CUBSPL(x,0,{x})*CUBSPL(z,0,{z})");
        let sum: Vec<String> = self.terms.iter().map(term).collect();
        let sum = if sum.is_empty() { "0".to_owned() } else { sum.join(" + ") };
        format!("{}(x,z) = {sum}", super::set::plain(&self.name))
    }

    /// The products that comments tell of, as [`Product::expression`] writes them, broken at blanks.
    pub(super) fn read(remarks: &str) -> Vec<Product> {
        let words: Vec<&str> = remarks.split_whitespace().collect();
        let mut out = Vec::new();
        for (k, pair) in words.windows(2).enumerate() {
            let Some(name) = pair[0].strip_suffix("(x,z)").filter(|name| !name.is_empty() && pair[1] == "=")
            else {
                continue;
            };
            let sum = words.get(k + 2..).unwrap_or(&[]);
            let Some(terms) = sum_of(sum) else { continue };
            out.push(Product {
                name: name.to_owned(),
                quantity: super::set::quantity(name),
                rails: None,
                terms,
            });
        }
        out
    }
}

/// `term + term + term`, up to what is no sum.
fn sum_of(words: &[&str]) -> Option<Vec<[u32; 2]>> {
    if words.first() == Some(&"0") {
        return Some(Vec::new());
    }
    let mut terms = Vec::new();
    for pair in words.chunks(2) {
        terms.push(term(pair[0])?);
        if pair.get(1) != Some(&"+") {
            break;
        }
    }
    (!terms.is_empty()).then_some(terms)
}

fn term(word: &str) -> Option<[u32; 2]> {
    let (x, z) = word.strip_prefix("CUBSPL(x,0,")?.split_once(")*CUBSPL(z,0,")?;
    Some([x.parse().ok()?, z.strip_suffix(')')?.parse().ok()?])
}
