//! A JSON text as a tree of values with their positions in the text.

use std::borrow::Cow;

use super::place::{Path, Step};

/// One value of a text.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeNode<'t> {
    /// Byte offset of its first byte.
    pub start: usize,
    /// Byte offset after its last byte; 0 if the text is truncated within the value.
    pub end: usize,
    /// Its content.
    pub value: Value<'t>,
}

/// The content of a value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value<'t> {
    /// `null`.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A number without sign, decimal point and exponent in the range of an unsigned integer of 64 bits.
    Unsigned(u64),
    /// A negative number without decimal point and exponent in the range of an integer of 64 bits.
    Signed(i64),
    /// Any other number, correctly rounded to double precision and finite.
    Float(f64),
    /// A string, with its escapes resolved.
    Text(Cow<'t, str>),
    /// The items of a list.
    List(Vec<TreeNode<'t>>),
    /// The members of an object in the order of the text; keys may be duplicate.
    Object(Vec<TreeMember<'t>>),
}

/// One member of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeMember<'t> {
    /// Byte offset of its key.
    pub start: usize,
    /// Its key, with escapes resolved.
    pub key: Cow<'t, str>,
    /// Its value.
    pub value: TreeNode<'t>,
}

/// The result of following a path in a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit<'n, 't> {
    /// The last value on the path that exists in the tree.
    pub node: &'n TreeNode<'t>,
    /// Byte offset of the key of that value if it is a member, otherwise of the value itself.
    pub key: usize,
    /// Whether the whole path exists in the tree.
    pub is_whole: bool,
}

impl<'t> TreeNode<'t> {
    /// Whether the text contains the complete value.
    #[must_use]
    pub const fn is_whole(&self) -> bool {
        self.end > self.start
    }

    /// The string, if the value is one.
    #[must_use]
    pub fn as_text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The member with that name, if the value is an object that contains it; the last one of duplicates.
    #[must_use]
    pub fn member(&self, key: &str) -> Option<&TreeMember<'t>> {
        match &self.value {
            Value::Object(members) => members.iter().rfind(|member| member.key == key),
            _ => None,
        }
    }

    /// The items, if the value is a list; otherwise empty.
    #[must_use]
    pub fn items(&self) -> &[TreeNode<'t>] {
        match &self.value {
            Value::List(items) => items,
            _ => &[],
        }
    }

    /// The first duplicate member, if the value is an object that contains one.
    #[must_use]
    pub fn second_of_a_key(&self) -> Option<&TreeMember<'t>> {
        let Value::Object(members) = &self.value else {
            return None;
        };
        let mut seen = std::collections::BTreeSet::new();
        members.iter().find(|member| !seen.insert(&member.key))
    }

    /// A copy without one member.
    #[must_use]
    pub fn without(&self, key: &str) -> TreeNode<'t> {
        let mut node = self.clone();
        if let Value::Object(members) = &mut node.value {
            members.retain(|member| member.key != key);
        }
        node
    }

    /// Calls `each` with the path and the items of every list in the value; `path` is that of the value itself.
    pub(super) fn for_each_list(
        &self,
        path: &mut Path,
        each: &mut impl FnMut(&Path, &[TreeNode<'t>]),
    ) {
        match &self.value {
            Value::List(items) => {
                each(path, items);
                for (index, item) in items.iter().enumerate() {
                    path.0.push(Step::Index(index));
                    item.for_each_list(path, each);
                    path.0.pop();
                }
            }
            Value::Object(members) => {
                for member in members {
                    path.0.push(Step::Key(member.key.clone().into_owned()));
                    member.value.for_each_list(path, each);
                    path.0.pop();
                }
            }
            _ => {}
        }
    }

    /// Follows a path as far as it exists in the tree.
    pub(super) fn find(&self, path: &Path) -> Hit<'_, 't> {
        let mut hit = Hit {
            node: self,
            key: self.start,
            is_whole: true,
        };
        for step in &path.0 {
            let next = match step {
                Step::Key(key) => hit
                    .node
                    .member(key)
                    .map(|member| (&member.value, member.start)),
                Step::Index(index) => hit.node.items().get(*index).map(|item| (item, item.start)),
            };
            match next {
                Some((node, key)) => {
                    hit = Hit {
                        node,
                        key,
                        is_whole: true,
                    }
                }
                None => {
                    return Hit {
                        is_whole: false,
                        ..hit
                    };
                }
            }
        }
        hit
    }

    /// Merges changes into this value (RFC 7386). Objects are merged member by member, `null` removes a member, and
    /// everything else replaces the value. An object that is changed takes the position of its changes.
    pub fn merge(&mut self, changes: TreeNode<'t>) {
        let Value::Object(changed) = changes.value else {
            *self = changes;
            return;
        };
        (self.start, self.end) = (changes.start, changes.end);
        if !matches!(self.value, Value::Object(_)) {
            self.value = Value::Object(Vec::new());
        }
        let Value::Object(members) = &mut self.value else {
            return;
        };
        for change in changed {
            let old = members.iter().position(|member| member.key == change.key);
            match (old, &change.value.value) {
                (Some(old), Value::Null) => drop(members.remove(old)),
                (None, Value::Null) => {}
                (Some(old), _) => members[old].value.merge(change.value),
                (None, _) => {
                    // the change is merged into an empty value, so that a `null` below it is dropped
                    let (start, end) = (change.value.start, change.value.end);
                    let mut value = TreeNode {
                        start,
                        end,
                        value: Value::Null,
                    };
                    value.merge(change.value);
                    members.push(TreeMember { value, ..change });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::json;
    use super::*;

    /// The value alone, as text.
    fn plain(node: &TreeNode<'_>) -> String {
        match &node.value {
            Value::Null => "null".to_owned(),
            Value::Bool(value) => value.to_string(),
            Value::Unsigned(value) => value.to_string(),
            Value::Signed(value) => value.to_string(),
            Value::Float(value) => format!("{value:?}"),
            Value::Text(text) => format!("{text:?}"),
            Value::List(items) => format!(
                "[{}]",
                items.iter().map(plain).collect::<Vec<_>>().join(",")
            ),
            Value::Object(members) => {
                let member =
                    |member: &TreeMember<'_>| format!("{:?}:{}", member.key, plain(&member.value));
                format!(
                    "{{{}}}",
                    members.iter().map(member).collect::<Vec<_>>().join(",")
                )
            }
        }
    }

    #[test]
    fn merge_follows_the_examples_of_rfc_7386() {
        // appendix A of the RFC: original, patch, result
        let cases = [
            (r#"{"a":"b"}"#, r#"{"a":"c"}"#, r#"{"a":"c"}"#),
            (r#"{"a":"b"}"#, r#"{"b":"c"}"#, r#"{"a":"b","b":"c"}"#),
            (r#"{"a":"b"}"#, r#"{"a":null}"#, "{}"),
            (r#"{"a":["b"]}"#, r#"{"a":"c"}"#, r#"{"a":"c"}"#),
            (
                r#"{"a":{"b":"c"}}"#,
                r#"{"a":{"b":"d","c":null}}"#,
                r#"{"a":{"b":"d"}}"#,
            ),
            (r#"{"a":[{"b":"c"}]}"#, r#"{"a":[1]}"#, r#"{"a":[1]}"#),
            ("{}", r#"{"a":{"bb":{"ccc":null}}}"#, r#"{"a":{"bb":{}}}"#),
            ("[1,2]", r#"{"a":"b","c":null}"#, r#"{"a":"b"}"#),
        ];
        for (original, patch, result) in cases {
            let mut merged = json::read(original).root;
            merged.merge(json::read(patch).root);
            assert_eq!(plain(&merged), result, "{patch}");
        }
    }

    #[test]
    fn every_value_knows_its_bytes() {
        let text = "{\"a\": [1, \"x\\n\"],\n \"b\": {\"c\": null}}";
        let root = json::read(text).root;
        let cut = |path: &[Step]| {
            let hit = root.find(&Path(path.to_vec()));
            assert!(hit.is_whole);
            &text[hit.node.start..hit.node.end]
        };
        let key = |key: &str| Step::Key(key.to_owned());
        assert_eq!(cut(&[]), text);
        assert_eq!(cut(&[key("a"), Step::Index(1)]), "\"x\\n\"");
        assert_eq!(cut(&[key("b"), key("c")]), "null");
        assert!(!root.find(&Path(vec![key("b"), key("d")])).is_whole);
    }
}
