//! Closed lists of subcommands.

/// A closed list of subcommands, each a line of help and the arguments, which run themselves (`run(&self, &dyn Console) -> Result<(), Error>`):
/// generates the enum that clap parses, and its dispatch.
macro_rules! subcommands {
    ($(#[$about:meta])* $List:ident: $($(#[$help:meta])* $Name:ident($Arguments:ty),)*) => {
        $(#[$about])*
        #[derive(Debug, clap::Subcommand)]
        pub enum $List {
            $($(#[$help])* $Name($Arguments),)*
        }

        impl $List {
            /// Runs the subcommand, and prints its answer.
            pub fn run(&self, console: &dyn $crate::console::Console) -> Result<(), etendue::Error> {
                match self {
                    $(Self::$Name(arguments) => arguments.run(console),)*
                }
            }
        }
    };
}
pub(crate) use subcommands;
