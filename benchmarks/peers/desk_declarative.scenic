# The desk of Fig. 2 (Kunze et al. 2014): everything anywhere on the desk, and a requirement for each relation; the
# scene of desk_declarative.qsr. A direction is a quarter of the plane; close-to is the nearer half of the way.
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
quarter = 45 deg

ego = new Monitor at (0, 0, 0), facing 180 deg
keyboard = new Keyboard in desk, facing 180 deg
laptop = new Laptop in desk, facing 180 deg
cup = new Cup in desk, facing 180 deg
bottle = new Bottle in desk, facing 180 deg

def direction(relatum, referent):
    return angle from relatum.position to referent.position

require abs(abs(direction(ego, keyboard)) - 180 deg) < quarter   # in-front-of(Keyboard, Monitor)
require abs(direction(keyboard, laptop) - 90 deg) < quarter      # left-of(Laptop, Keyboard)
require abs(direction(keyboard, cup) + 90 deg) < quarter         # right-of(Cup, Keyboard)
require abs(direction(cup, bottle)) < quarter                    # behind-of(Bottle, Cup)
require (distance from bottle.position to cup.position) < 0.25   # close-to(Bottle, Cup)
require keyboard in desk
require laptop in desk
require cup in desk
require bottle in desk
