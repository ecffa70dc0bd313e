"""From text to a Document: source, syntax, parser, diagnostics."""
