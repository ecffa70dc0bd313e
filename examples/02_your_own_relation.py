"""Define a relation, state what is known with it, and ask."""

import qsrlang as qsr

known = qsr.parse_knowledge("""
surface Table { size: 120 cm × 80 cm, height: 72 cm }.
static  Plate { size: 26 cm × 26 cm × 3 cm, front: yes, on: Table }.
dynamic Fork  { size: 2 cm × 20 cm × 2 cm, on: Table }.

relation beside(referent, relatum) {
    angle: mix(normal(90 deg, 15 deg), normal(-90 deg, 15 deg)), distance: uniform(1 cm, 8 cm)
}.
believe 0.9 :: beside(Fork, Plate) | 0.1 :: behind-of(Fork, Plate) ∧ close-to(Fork, Plate).

landmark table-1 : Table at (0 m, 0 m) facing -90 deg.
landmark plate-1 : Plate at (0 m, -22 cm) facing -90 deg.
""")
print(known.where("Fork"))
