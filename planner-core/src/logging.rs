//! The one door to logs. The features `defmt` and `log` open it, one or both; without
//! either, nothing is left of it in the program. No log changes what a planner does.
//!
//! | level | what |
//! |---|---|
//! | warn | somebody should look: poses off the grid, looks that contradict the map, two robots with one id, others who tell otherwise than was seen, giving up |
//! | info | reset; stop, with its reason |
//! | debug | why it begins to wait, walls taken back, frames refused, robots first heard and forgotten |
//! | trace | what may come in every tick: looks asked for, echoes of own frames |

/// Logs at a level: `log!(info, "robot {}: …", id.0)`. The values have `defmt::Format` and
/// what the format asks for; they are not evaluated where nobody listens.
macro_rules! log {
    ($level:ident, $format:literal $(, $value:expr)+ $(,)?) => {{
        #[cfg(feature = "defmt")]
        ::defmt::$level!($format $(, $value)+);
        #[cfg(feature = "log")]
        ::log::$level!($format $(, $value)+);
        #[cfg(not(any(feature = "defmt", feature = "log")))]
        if false {
            let _ = ($(&$value,)+);
        }
    }};
}
