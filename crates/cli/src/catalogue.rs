//! The arguments of every subcommand, for programs that offer the same verbs.

use clap::{Arg, ArgAction, Command};
use serde::Serialize;
use std::any::TypeId;
use std::path::PathBuf;

/// A verb, or a group of verbs such as `measure`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Subcommand {
    /// Word on the command line.
    pub name: String,
    /// Description, one sentence.
    pub help: String,
    /// Arguments; empty for a group.
    pub arguments: Vec<Argument>,
    /// Verbs of a group.
    pub verbs: Vec<Subcommand>,
}

/// Kind of an argument's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ArgumentKind {
    /// A switch without a value.
    Switch,
    /// A whole number.
    Integer,
    Number,
    Path,
    /// A text, or numbers written as one: `1,2`, `0..10`.
    Text,
}

/// An argument of a verb.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Argument {
    /// The option without its dashes; for a positional value its own name, in lower case.
    pub name: String,
    /// True for a positional value.
    pub positional: bool,
    /// True if it is required.
    pub required: bool,
    /// True if it may be given more than once.
    pub many: bool,
    /// True if several values are separated by commas.
    pub listed: bool,
    /// Kind of its values.
    pub kind: ArgumentKind,
    /// Placeholder of its value in the help, such as `X,Y,W,H`.
    pub value: String,
    /// The allowed words; empty if any value is allowed.
    pub words: Vec<String>,
    /// Default value, as typed; `None` if it is only described in the help.
    pub default: Option<String>,
    /// Meaning, with unit.
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
                false => {
                    verb.get_arguments().filter(|argument| !is_everywhere(argument)).map(argument_report).collect()
                }
            },
        })
        .collect()
}

/// True for help, version, and options of the whole program.
fn is_everywhere(argument: &Arg) -> bool {
    ["help", "version"].contains(&argument.get_id().as_str()) || argument.is_global_set()
}

fn argument_report(argument: &Arg) -> Argument {
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

fn kind(argument: &Arg, is_switch: bool) -> ArgumentKind {
    let type_id = argument.get_value_parser().type_id();
    let is_one = |types: &[TypeId]| types.iter().any(|one| type_id == *one);
    match type_id {
        _ if is_switch => ArgumentKind::Switch,
        _ if is_one(&[
            TypeId::of::<u8>(),
            TypeId::of::<u32>(),
            TypeId::of::<u64>(),
            TypeId::of::<usize>(),
            TypeId::of::<i64>(),
        ]) =>
        {
            ArgumentKind::Integer
        }
        _ if is_one(&[TypeId::of::<f64>()]) => ArgumentKind::Number,
        _ if is_one(&[TypeId::of::<PathBuf>()]) => ArgumentKind::Path,
        _ => ArgumentKind::Text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find<'a>(verbs: &'a [Subcommand], name: &str) -> &'a Subcommand {
        verbs.iter().find(|verb| verb.name == name).expect("a verb of that name")
    }

    #[test]
    fn every_verb_is_listed_with_its_arguments() {
        let verbs = catalogue();
        let measure = find(&verbs, "measure");
        assert!(measure.arguments.is_empty() && measure.verbs.len() > 15);
        let sfr = find(&measure.verbs, "sfr");
        let argument = |name: &str| sfr.arguments.iter().find(|a| a.name == name).expect("an argument of that name");
        assert_eq!((argument("picture").positional, argument("picture").kind), (true, ArgumentKind::Path));
        assert_eq!(
            (argument("edge-degree").kind, argument("edge-degree").default.as_deref()),
            (ArgumentKind::Integer, Some("1"))
        );
        assert_eq!((argument("edge").many, argument("edge").value.as_str()), (true, "X,Y,W,H"));
        assert_eq!((argument("json").kind, argument("json").default.as_deref()), (ArgumentKind::Switch, None));
        assert!(sfr.arguments.iter().all(|a| !a.help.is_empty() && a.name != "limit" && a.name != "help"));
    }
}
