//! Poses from a Polhemus Fastrak, Liberty or Patriot.
