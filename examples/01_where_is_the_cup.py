"""Ask what a .qsr file says of a cup, and draw the answer."""

import qsrlang as qsr

known = qsr.load("office/desk").with_landmarks(
    "monitor-1 : Monitor at (1.2 m, 3 m) facing -90 deg ± (2 cm, 2 cm, 3 deg)",
    "desk-1 : Desk at (1.2 m, 2.8 m) facing -90 deg",
)
answer = known.where("Cup")
print(answer)
for component in answer.components:
    print(f"{component.weight:.2f} because of", *component.statements, sep="\n     ")
print(qsr.save_figure(qsr.draw_answer(answer, known), "cup.png"))
