"""Small changes to texts, as typing slips, damaged files and misunderstandings make them."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence

TOKEN = re.compile(r"\s+|[^\W\d][\w-]*|\d+(?:\.\d+)?|::|<=>|\S")
NAME = re.compile(r"[^\W\d]\w*(?:-\w+)*")
STATEMENT = re.compile(r"(?<=[.}])\s+")
ODD = (
    *(
        "\x00",
        "\ud800",
        "\udfff",
        "\u202e",
        "\u2066",
        "\ufeff",
        "\r",
        "\x0b",
        "\x85",
        "\u2028",
        "\x1b[31m",
        "\t",
    ),
    *(
        "🦉",
        "é",
        "e\u0301",
        "²",
        "١٢",
        "ǅ",
        "§",
        "\\",
        "'",
        '"',
        "#",
        "##",
        "# allow Q503",
        ";",
        "`",
        "_",
        "--",
        "-",
    ),
    *(
        ".",
        "..",
        "?",
        ":",
        "::",
        "|",
        "~",
        ",",
        "()",
        "((((",
        "))))",
        "{",
        "}",
        "}}",
        "[",
        "]",
        "∧",
        "∨",
        "¬",
        "⇔",
        "×",
        "±",
    ),
    *(
        "0",
        "-0",
        "1e400",
        "1e-400",
        "9" * 400,
        "0" * 5000,
        "99999999999999999999",
        "0.1.2",
        "24:00",
        "99:99",
        "%",
        "200 %",
    ),
    *(
        "in ",
        "not ",
        "and ",
        "x",
        "wrt intrinsic",
        "elsewhere",
        "a.b",
        "a.",
        "../../../x.qsr",
        "left: ",
        "given ",
    ),
)
Change = Callable[[str, random.Random, Sequence[str]], str]


def mutate(text: str, chance: random.Random, others: Sequence[str]) -> str:
    """Return the text after one to four changes; `others` are texts to take parts from."""
    for _ in range(chance.choice((1, 1, 1, 2, 2, 3, 4))):
        text = chance.choice(CHANGES)(text, chance, others)
    return text


def flip_bytes(text: str, chance: random.Random, others: Sequence[str]) -> str:
    """Change one to three bytes of the encoded text."""
    content = bytearray(text.encode("utf-8", "surrogatepass") or b" ")
    for _ in range(chance.randint(1, 3)):
        content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
    return content.decode("utf-8", chance.choice(("replace", "surrogateescape", "ignore")))


def delete(text: str, chance: random.Random, others: Sequence[str]) -> str:
    """Delete up to twenty characters."""
    start = chance.randint(0, len(text))
    return text[:start] + text[start + chance.randint(1, 20) :]


def repeat(text: str, chance: random.Random, others: Sequence[str]) -> str:
    """Repeat up to forty characters up to four times."""
    start = chance.randint(0, len(text))
    end = start + chance.randint(1, 40)
    return text[:end] + text[start:end] * chance.randint(1, 4) + text[end:]


def insert_odd(text: str, chance: random.Random, others: Sequence[str]) -> str:
    """Insert something odd."""
    at = chance.randint(0, len(text))
    return text[:at] + chance.choice(ODD) + text[at:]


def swap_tokens(text: str, chance: random.Random, others: Sequence[str]) -> str:
    """Swap two tokens."""
    tokens = TOKEN.findall(text) or [""]
    one, other = chance.randrange(len(tokens)), chance.randrange(len(tokens))
    tokens[one], tokens[other] = tokens[other], tokens[one]
    return "".join(tokens)


def replace_token(text: str, chance: random.Random, others: Sequence[str]) -> str:
    """Put a token of another text, or something odd, in place of one."""
    tokens = TOKEN.findall(text) or [""]
    foreign = TOKEN.findall(chance.choice(others)) or [""]
    tokens[chance.randrange(len(tokens))] = chance.choice((chance.choice(foreign), chance.choice(ODD)))
    return "".join(tokens)


def rename(text: str, chance: random.Random, others: Sequence[str]) -> str:
    """Write one name in place of another, everywhere or once."""
    names = NAME.findall(text) or ["x"]
    old, new = chance.choice(names), chance.choice(names)
    return text.replace(old, new, chance.choice((1, -1)))


def splice(text: str, chance: random.Random, others: Sequence[str]) -> str:
    """Go over into another text somewhere."""
    other = chance.choice(others)
    return text[: chance.randint(0, len(text))] + other[chance.randint(0, len(other)) :]


def borrow_statement(text: str, chance: random.Random, others: Sequence[str]) -> str:
    """Insert a statement of another text between two statements."""
    own, foreign = STATEMENT.split(text), STATEMENT.split(chance.choice(others))
    own.insert(chance.randint(0, len(own)), chance.choice(foreign))
    return "\n".join(own)


def shuffle_statements(text: str, chance: random.Random, others: Sequence[str]) -> str:
    """Put the statements in another order, or drop one."""
    statements = STATEMENT.split(text)
    chance.shuffle(statements)
    return "\n".join(statements[chance.randint(0, 1) :])


CHANGES: tuple[Change, ...] = (
    *(flip_bytes, delete, repeat, insert_odd, swap_tokens, replace_token, rename, splice),
    *(borrow_statement, shuffle_statements, rename, replace_token),
)
