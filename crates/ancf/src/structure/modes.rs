//! Natural frequencies and shapes about an equilibrium, at rest or in a rotating frame.
