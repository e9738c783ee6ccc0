//! What a key of a machine file means: the schema of `post schema` says it, in the words of the types that read it.

use std::sync::LazyLock;

use serde_json::Value;

use post_job::machine_schema;

static SCHEMA: LazyLock<Value> = LazyLock::new(machine_schema::schema);

/// What the schema says of a place.
#[derive(Clone, Copy, Debug)]
pub struct Meaning {
    /// Where the key is named: its description, default and limits.
    named: &'static Value,
    /// Its type, references followed.
    kind: &'static Value,
}

/// What can be written for a value.
pub struct Choice {
    /// As a text, without quotes.
    pub value: String,
    /// What it means.
    pub meaning: String,
}

/// The type that a reference leads to.
fn followed(mut node: &'static Value) -> &'static Value {
    loop {
        let reference =
            node.get("$ref").or_else(|| node.pointer("/allOf/0/$ref")).and_then(Value::as_str);
        let Some(reference) = reference else {
            return node;
        };
        let Some(next) = SCHEMA.pointer(reference.trim_start_matches('#')) else {
            return node;
        };
        node = next;
    }
}

impl Meaning {
    /// Of the keys that lead to a place; none for keys that nothing has.
    pub fn of<S: AsRef<str>>(path: &[S]) -> Option<Self> {
        let mut found = Self { named: &SCHEMA, kind: &SCHEMA };
        for key in path {
            let key = key.as_ref();
            let named = if let Some(index) = key.strip_prefix('[') {
                let items = found.kind.get("items")?;
                let index = index.trim_end_matches(']').parse::<usize>().ok()?;
                items.get(index).unwrap_or(items)
            } else {
                let own = found.kind.get("properties").and_then(|keys| keys.get(key));
                own.or_else(|| found.kind.get("additionalProperties"))?
            };
            if !named.is_object() {
                return None;
            }
            found = Self { named, kind: followed(named) };
        }
        Some(found)
    }

    /// Keys that the table has, each with what it means.
    pub fn keys(self) -> impl Iterator<Item = (&'static str, Meaning)> {
        let keys = self.kind.get("properties").and_then(Value::as_object);
        keys.into_iter().flatten().map(|(key, named)| {
            let kind = followed(named);
            (key.as_str(), Meaning { named, kind })
        })
    }

    /// It is a table, with keys of its own or of the user's.
    pub fn is_table(self) -> bool {
        self.kind.get("type").is_some_and(|kind| kind == "object")
    }

    /// It is a number, or an expression of parameters.
    pub fn is_number(self) -> bool {
        let kinds = self.kind.get("type").and_then(Value::as_array);
        kinds.is_some_and(|kinds| kinds.iter().any(|kind| kind == "number"))
            && self.kind.get("items").is_none()
    }

    /// It is true or false.
    pub fn is_flag(self) -> bool {
        self.kind.get("type").is_some_and(|kind| kind == "boolean")
    }

    /// What it means, in a sentence or two; of a type that has no name of its own what the type is.
    pub fn description(self) -> Option<&'static str> {
        let of = |node: &'static Value| node.get("description").and_then(Value::as_str);
        of(self.named).or_else(|| of(self.kind))
    }

    /// The words that it can be.
    pub fn choices(self) -> Vec<Choice> {
        let list = |key: &str| self.kind.get(key).and_then(Value::as_array);
        let mut choices = Vec::new();
        for word in list("enum").into_iter().flatten() {
            choices.extend(
                word.as_str().map(|word| Choice { value: word.to_owned(), meaning: String::new() }),
            );
        }
        let described = list("oneOf").or_else(|| list("anyOf"));
        for one in described.into_iter().flatten() {
            let meaning = one["description"].as_str().unwrap_or_default();
            let word = one.get("const").or_else(|| one.pointer("/enum/0"));
            choices.extend(
                word.and_then(Value::as_str)
                    .map(|word| Choice { value: word.to_owned(), meaning: meaning.to_owned() }),
            );
        }
        choices
    }

    /// Its limits and default, those that the schema states beside the description.
    fn limits(self) -> Option<String> {
        let told = [
            ("minimum", "at least"),
            ("exclusiveMinimum", "above"),
            ("maximum", "at most"),
            ("default", "default"),
        ];
        let told = told.iter().filter_map(|(key, says)| {
            let value = self.named.get(*key).or_else(|| self.kind.get(*key))?;
            (!value.is_object() && !value.is_array()).then(|| format!("{says} {value}"))
        });
        let told: Vec<String> = told.collect();
        (!told.is_empty()).then(|| told.join(", "))
    }

    /// All of it, in Markdown.
    pub fn text(self) -> String {
        let mut text = self.description().unwrap_or_default().to_owned();
        if let Some(limits) = self.limits() {
            text.push_str(&format!("\n\n{limits}"));
        }
        for choice in self.choices() {
            text.push_str(&format!("\n- `{}`", choice.value));
            if !choice.meaning.is_empty() {
                text.push_str(&format!(": {}", choice.meaning));
            }
        }
        text
    }
}
