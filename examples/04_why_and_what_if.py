"""Ask why a cup is where it is, what if, which landmark to look for first, and how all of it may look together."""

import qsrlang as qsr

known = qsr.parse_knowledge("""
static  Monitor { size: 55 cm × 20 cm × 40 cm, front: yes }.
dynamic Keyboard { size: 45 cm × 15 cm × 3 cm }.
dynamic Cup { size: 8 cm × 8 cm × 10 cm }, Bottle { size: 7 cm × 7 cm × 25 cm }.
landmark monitor-1 : Monitor at (0 m, 0 m) facing -90 deg ± (2 cm, 2 cm, 3 deg).

believe in-front-of(Keyboard, Monitor) ∧ close-to(Keyboard, Monitor).
believe 60 % :: right-of(Cup, Keyboard) | 30 % :: left-of(Cup, Keyboard) | elsewhere.
believe behind-of(Bottle, Cup) ∧ close-to(Bottle, Cup).
""")
print(known.explain("Cup"))  # the worlds behind `where`: shares, lines of the text, places
print(known.prob("close-to(Cup, Keyboard)"))
print(known.prob("right-of(Cup, Keyboard)", given="right-of(Bottle, Monitor)"))  # what if
print(known.rank_landmarks("Bottle"))  # how much knowing the place of each narrows the search
print(known.sample("Bottle", 1000))  # joint scenes in which no boxes overlap

seen = known.with_landmarks("bottle-1 : Bottle at (-45 cm, 2 cm) facing -90 deg")
print(seen.explain("Cup"))  # the bottle, seen on the left, weighs the worlds: evidence

doubted = qsr.parse_knowledge("""
static Monitor. dynamic Keyboard, Laptop, Cup, Bottle.
scene(Monitor, Keyboard, Laptop, Cup, Bottle) ⇔
    in-front-of(Keyboard, Monitor) ∧ left-of(Laptop, Keyboard) ∧ right-of(Cup, Keyboard) ∧ behind-of(Bottle, Cup).
require left-of(Bottle, Laptop).
""")
print(
    doubted.check()
)  # four atoms that cannot all hold, with their places, and the least change that ends it
