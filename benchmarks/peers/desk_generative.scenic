# The desk of Fig. 2 (Kunze et al. 2014), drawn object by object: the scene of desk_generative.qsr.
# +y points away from the viewer; the monitor stands at the origin and faces the viewer.
class Monitor:
    width: 0.55
    length: 0.20

class Keyboard:
    width: 0.45
    length: 0.15

class Laptop:
    width: 0.33
    length: 0.23

class Cup:
    width: 0.08
    length: 0.08

class Bottle:
    width: 0.07
    length: 0.07

desk = RectangularRegion((0, -0.2, 0), 0, 1.5, 0.8)
sd = 11.25

ego = new Monitor at (0, 0, 0), facing 180 deg
keyboard = new Keyboard at ego.position offset along (Normal(180, sd) deg) by (0, Range(0.175, 0.5), 0)
laptop = new Laptop at keyboard.position offset along (Normal(90, sd) deg) by (0, Range(0.39, 0.6), 0)
cup = new Cup at keyboard.position offset along (Normal(-90, sd) deg) by (0, Range(0.265, 0.7), 0)
bottle = new Bottle at cup.position offset along (Normal(0, sd) deg) by (0, Range(0.075, 0.25), 0)

require keyboard in desk
require laptop in desk
require cup in desk
require bottle in desk
