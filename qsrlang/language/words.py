"""What a name is made of, in any script: a letter, then letters, digits, `_` and marks, and inner hyphens."""

from __future__ import annotations

# Marks that stand with letters but are none: accents, and the vowel signs of the scripts of India, Sri Lanka, Thailand,
# Laos, Myanmar, Cambodia and Japan. Python's \w has letters, digits and `_` alone.
MARKS = (
    r"\u0300-\u036f\u0900-\u0963\u0966-\u0df3\u0e31\u0e34-\u0e3a\u0e47-\u0e4e\u0eb1\u0eb4-\u0ebc\u0ec8-\u0ece"
    r"\u102b-\u103e\u1056-\u1059\u17b6-\u17d3\u3099\u309a"
)
LETTER = r"[^\W\d]"
WORD = rf"{LETTER}[\w{MARKS}]*(?:-[\w{MARKS}]+)*"
