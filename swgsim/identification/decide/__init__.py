"""The decision by evidence: options with a prior and a likelihood, a search for them, and their posterior."""
