"""From a Document to a RelationGraph: what is known, as choices between constraints on pairs."""
