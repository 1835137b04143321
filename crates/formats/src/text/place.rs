//! Places in a JSON document: paths of keys and indices.

use std::fmt;

/// One step of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// Step to the member of an object.
    Key(String),
    /// Step to the item of a list, counted from 0.
    Index(usize),
}

/// An owned path from the root of a document.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Path(pub Vec<Step>);

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, step) in self.0.iter().enumerate() {
            match step {
                Step::Index(index) => write!(f, "[{index}]")?,
                Step::Key(key) if is_plain(key) => {
                    if position > 0 {
                        write!(f, ".")?;
                    }
                    write!(f, "{key}")?;
                }
                Step::Key(key) => write!(f, "[{key:?}]")?,
            }
        }
        Ok(())
    }
}

fn is_plain(key: &str) -> bool {
    !key.is_empty()
        && key
            .chars()
            .all(|c| c.is_alphanumeric() || c == '_' || c == '-')
}

/// A place in a document that is being read. It is a chain of steps on the stack and is converted to a [`Path`] only
/// for a fault.
///
/// ```
/// use formats::text::place::Place;
///
/// let root = Place::root();
/// let bodies = root.key("bodies");
/// let body = bodies.key("north bridge");
/// assert_eq!(body.key("inertia").index(2).path().to_string(), "bodies[\"north bridge\"].inertia[2]");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    above: Option<&'a Place<'a>>,
    step: Here<'a>,
}

#[derive(Clone, Copy, Debug)]
enum Here<'a> {
    Root,
    Key(&'a str),
    Index(usize),
}

impl<'a> Place<'a> {
    /// The document itself.
    #[must_use]
    pub const fn root() -> Place<'static> {
        Place {
            above: None,
            step: Here::Root,
        }
    }

    /// The member `key` of the object at this place.
    #[must_use]
    pub const fn key(&'a self, key: &'a str) -> Place<'a> {
        Place {
            above: Some(self),
            step: Here::Key(key),
        }
    }

    /// Item `index` of the list at this place.
    #[must_use]
    pub const fn index(&'a self, index: usize) -> Place<'a> {
        Place {
            above: Some(self),
            step: Here::Index(index),
        }
    }

    /// The owned path of this place.
    #[must_use]
    pub fn path(&self) -> Path {
        let mut steps = Vec::new();
        let mut here = Some(self);
        while let Some(place) = here {
            match place.step {
                Here::Root => {}
                Here::Key(key) => steps.push(Step::Key(key.to_owned())),
                Here::Index(index) => steps.push(Step::Index(index)),
            }
            here = place.above;
        }
        steps.reverse();
        Path(steps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn path_is_written_with_dots_brackets_and_quotes_where_a_key_needs_them() {
        let root = Place::root();
        let bodies = root.key("bodies");
        let body = bodies.key("north bridge");
        let inertia = body.key("inertia");
        assert_eq!(
            inertia.index(2).path().to_string(),
            "bodies[\"north bridge\"].inertia[2]"
        );
        assert_eq!(root.path().to_string(), "");
        let spans = root.key("girder");
        assert_eq!(
            spans.key("spans").index(1).path().to_string(),
            "girder.spans[1]"
        );
    }
}
