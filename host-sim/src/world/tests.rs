//! Laws of worlds, whatever they come from.
