"""The shell of `qsr repl`: what is typed, what it changes, and what is shown."""
