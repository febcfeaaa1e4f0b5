//! What the command line takes, for programs that offer the same verbs: every subcommand with its arguments.

use clap::{Arg, ArgAction, Command};
use serde::Serialize;
use std::any::TypeId;
use std::path::PathBuf;

/// A verb, or a group of verbs such as `measure`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Subcommand {
    /// Its word on the command line.
    pub name: String,
    /// What it does, a sentence.
    pub help: String,
    /// What it takes; empty for a group.
    pub arguments: Vec<Argument>,
    /// The verbs of a group.
    pub verbs: Vec<Subcommand>,
}

/// What values of an argument are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Given or not.
    Switch,
    /// A whole number.
    Integer,
    /// A number.
    Number,
    /// A path.
    Path,
    /// A text, or numbers that are written as one: `1,2`, `0..10`.
    Text,
}

/// An argument of a verb.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Argument {
    /// The option without its dashes; of a value without an option its own name, in small letters.
    pub name: String,
    /// Whether it is a value without an option, in its place.
    pub positional: bool,
    /// Whether it must be given.
    pub required: bool,
    /// Whether it may be given more than once.
    pub many: bool,
    /// Whether values that are given together are written with commas between them.
    pub listed: bool,
    /// What its values are.
    pub kind: Kind,
    /// What stands for its value in the help, such as `X,Y,W,H`.
    pub value: String,
    /// The only words that are allowed; empty: any.
    pub words: Vec<String>,
    /// What stands where it is not given, as typed; `None`: the help says.
    pub default: Option<String>,
    /// What it means, with its unit.
    pub help: String,
}

/// All verbs.
#[must_use]
pub fn catalogue() -> Vec<Subcommand> {
    let mut command = crate::command();
    command.build();
    subcommands(&command)
}

fn subcommands(command: &Command) -> Vec<Subcommand> {
    let verbs = command.get_subcommands().filter(|verb| verb.get_name() != "help");
    verbs
        .map(|verb| Subcommand {
            name: verb.get_name().to_owned(),
            help: verb.get_about().map(ToString::to_string).unwrap_or_default(),
            verbs: subcommands(verb),
            arguments: match verb.has_subcommands() {
                true => Vec::new(),
                false => verb.get_arguments().filter(|argument| !is_everywhere(argument)).map(told).collect(),
            },
        })
        .collect()
}

/// Help, version, and options of the program as a whole.
fn is_everywhere(argument: &Arg) -> bool {
    ["help", "version"].contains(&argument.get_id().as_str()) || argument.is_global_set()
}

fn told(argument: &Arg) -> Argument {
    let id = argument.get_id().as_str();
    let many = matches!(argument.get_action(), ArgAction::Append)
        || argument.get_num_args().is_some_and(|n| n.max_values() > 1);
    let words = argument.get_possible_values();
    let words = words.iter().map(|word| word.get_name().to_owned());
    let is_switch = matches!(argument.get_action(), ArgAction::SetTrue);
    let defaults: Vec<String> =
        argument.get_default_values().iter().map(|value| value.to_string_lossy().into_owned()).collect();
    Argument {
        name: argument.get_long().map_or_else(|| id.to_owned(), str::to_owned),
        positional: argument.is_positional(),
        required: argument.is_required_set(),
        listed: argument.get_value_delimiter().is_some(),
        many: many && !is_switch,
        kind: kind(argument, is_switch),
        value: argument.get_value_names().and_then(|names| names.first()).map(ToString::to_string).unwrap_or_default(),
        words: if is_switch { Vec::new() } else { words.collect() },
        default: Some(defaults.join(","))
            .filter(|text| !text.is_empty() && !is_switch && !argument.is_hide_default_value_set()),
        help: argument.get_help().map(ToString::to_string).unwrap_or_default(),
    }
}

fn kind(argument: &Arg, is_switch: bool) -> Kind {
    let type_id = argument.get_value_parser().type_id();
    let is_one = |types: &[TypeId]| types.iter().any(|one| type_id == *one);
    match type_id {
        _ if is_switch => Kind::Switch,
        _ if is_one(&[
            TypeId::of::<u8>(),
            TypeId::of::<u32>(),
            TypeId::of::<u64>(),
            TypeId::of::<usize>(),
            TypeId::of::<i64>(),
        ]) =>
        {
            Kind::Integer
        }
        _ if is_one(&[TypeId::of::<f64>()]) => Kind::Number,
        _ if is_one(&[TypeId::of::<PathBuf>()]) => Kind::Path,
        _ => Kind::Text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find<'a>(verbs: &'a [Subcommand], name: &str) -> &'a Subcommand {
        verbs.iter().find(|verb| verb.name == name).expect("a verb of that name")
    }

    #[test]
    fn every_verb_is_told_with_what_it_takes() {
        let verbs = catalogue();
        let measure = find(&verbs, "measure");
        assert!(measure.arguments.is_empty() && measure.verbs.len() > 15);
        let sfr = find(&measure.verbs, "sfr");
        let argument = |name: &str| sfr.arguments.iter().find(|a| a.name == name).expect("an argument of that name");
        assert_eq!((argument("picture").positional, argument("picture").kind), (true, Kind::Path));
        assert_eq!(
            (argument("edge-degree").kind, argument("edge-degree").default.as_deref()),
            (Kind::Integer, Some("1"))
        );
        assert_eq!((argument("edge").many, argument("edge").value.as_str()), (true, "X,Y,W,H"));
        assert_eq!((argument("json").kind, argument("json").default.as_deref()), (Kind::Switch, None));
        assert!(sfr.arguments.iter().all(|a| !a.help.is_empty() && a.name != "limit" && a.name != "help"));
    }
}
