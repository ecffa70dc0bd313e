"""What editors show and do: colours, completions, and a language server."""
