"""From nodes and texts to well laid out text: printer and formatter on one layout."""
