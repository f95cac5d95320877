//! What is promised of each family.
