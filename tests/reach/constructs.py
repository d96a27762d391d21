"""What tasks of other benchmarks are made of, and how Probe says each: text that must compile."""

# Stands before every text.
PRELUDE = '''
use "{suite}/kitchen_stage.probe"
use "{suite}/language.probe"
use "std/place.probe"
use "std/contact.probe"
use "std/space.probe"
use "std/fixtures.probe"
use "std/controls.probe"
role helper
abstract task plain {{
  scene counter; layout spots; say put_the; horizon 300 steps; source carrot; target plate; metrics base
}}
metrics base {{ success = at end on_top_of(source, target) }}
'''

LAYOUT = "cells c = grid 2 x 2 at (-16cm, -4cm) spread (10.5cm, 11cm)\n  orient by rest\n  drop 10cm settle 0.5s\n  "


def goal(condition, task=""):
    """A task whose success is the condition; words that say nothing contradict none."""
    words = "" if "say " in task else "say do_it; "
    return f"metrics asked {{ success = at end ({condition}) }}\ntask t like plain {{ metrics asked; {words}{task} }}\n"


def layout(lines, task=""):
    """A task that begins so."""
    return f"layout begun {{\n  {LAYOUT}{lines}\n}}\ntask t like plain {{ layout begun; {task} }}\n"


# key: (in words, text)
CONSTRUCTS = {
    # goals
    "goal: on an object": ("an object lies on another", goal("on_top_of(source, target)")),
    "goal: on a place": ("an object lies on a place of the table or of a fixture", goal("lies_in(source, cabinet.on_top)")),
    "goal: in a place": ("an object lies in a drawer, an oven, a rack", goal("put_in(source, cabinet.inside_top)")),
    "goal: in an object": ("an object lies in a hollow one", goal("inside(source, target)", "target bowl")),
    "goal: opened": ("a drawer or door is open", goal("opened(cabinet.top_drawer)")),
    "goal: closed": ("a drawer or door is closed", goal("closed(cabinet.top_drawer)")),
    "goal: turned": ("a knob is turned on or off", goal("turned(stove.left_knob) and not turned(stove.right_knob)")),
    "goal: several": ("several of these at once", goal("on_top_of(source, target) and closed(cabinet.top_drawer)")),
    "goal: negated": ("one of these does not hold", goal("not on_top_of(source, target)")),
    "goal: touching": ("two objects touch", goal("in_contact(source, target)")),
    "goal: distance": ("two objects are close", goal("distance(source, target) < 5cm")),
    "goal: held": ("an object is in the gripper, or nothing is", goal("held(source) and not held(target)")),
    "goal: lifted": ("an object is picked up", goal("lifted(source) and held(source)")),
    "goal: near": ("an object comes close to another, nearest of all", goal("next_to(source, target) and displaced(source)")),
    # what must not happen
    "cost: touched": ("the arm touches something", goal("not bumped(plate)")),
    "cost: near the gripper": ("the gripper comes close to something", goal("distance(tcp, source) < 5cm")),
    "cost: part near the gripper": ("the gripper comes close to a part of an object",
        'object knife like spoon { region blade box (-7cm, -2cm, -1.5cm) .. (0cm, 2cm, 1.5cm) }\n'
        + goal("within(tcp, knife.blade)", "source knife")),
    "cost: fell": ("something falls down", goal("height(source) - height(start(source)) > -5cm")),
    "cost: over time": ("something held at any time or in how many steps",
        "metrics counted { success = at end on_top_of(source, target); hit = once bumped(target) }\n"
        "task t like plain { metrics counted }\n"),
    # starts
    "start: on the table": ("objects begin at drawn places of the table", layout("place source, target in distinct c")),
    "start: from a file": ("starts are a list of poses", 'layout begun { starts "starts.csv"; drop 5cm settle 0.5s }\ntask t like plain { layout begun }\n'),
    "start: on an object": ("an object begins on another", layout("place target in distinct c\n  place source on target")),
    "start: in a place": ("an object begins in a drawer or on a fixture",
        layout("place target in distinct c\n  place source in cabinet.inside_top", "start cabinet.top 10cm")),
    "start: joints": ("a drawer begins open, a knob turned", "task t like plain { start cabinet.top 10cm; start stove.left 60deg }\n"),
    "start: moving along a line": ("an object moves along a line", "task t like plain { distractors mug; moves mug along (5cm, 0cm) at 5cm/s }\n"),
    "start: moving round or by points": ("an object moves on a circle or from point to point", "task t like plain { distractors mug; moves mug around (0cm, 3cm) at 5cm/s }\n"),
    "start: robot": ("the arm begins elsewhere", "layout shaken like spots { joints jitter 3deg }\ntask t like plain { layout shaken }\n"),
    # what is varied
    "words": ("the instruction is worded otherwise", 'template other frame put "set {the source} down on {the target}"\ntask t like plain { say other }\n'),
    "words: two, one after the other": ("the instruction changes in the course of the episode",
        goal("opened(cabinet.top_drawer) and in_contact(source, plate)", 'say "open {the cabinet.top_drawer}"; '
             'then say "put {the source} on {the target}" when opened(cabinet.top_drawer) or step >= 101')),
    "more objects": ("other things lie about", "task t like plain { distractors mug, bottle }\n"),
    "camera": ("the camera stands elsewhere", "camera aside like agentview { mount panda.link0 at (130cm, 20cm, 70cm) look (-0.77, -0.12, -0.62) }\nscene seen like counter { camera aside }\ntask t like plain { scene seen }\n"),
    "light": ("light of other power or direction", "light dim { ambient 0.2; sun (0, 0, -1) power 0.7 }\nscene lit like counter { light dim }\ntask t like plain { scene lit }\n"),
    "light: colour": ("light of another colour", "light warm { ambient 0.3; sun (0, 0, -1) power 1.5; color (1, 0.8, 0.6) }\nscene lit like counter { light warm }\ntask t like plain { scene lit }\n"),
    "sensor": ("noise, blur, exposure in the picture", "camera noisy like agentview { sensor noise 0.05 }\nscene seen like counter { camera noisy }\ntask t like plain { scene seen }\n"),
    "texture: surface": ("another texture of the table", 'scene clad like counter { texture surface "wood" }\ntask t like plain { scene clad }\n'),
    "texture: walls": ("another texture of walls or floor", 'scene clad like counter { texture walls "bricks"; texture floor "wood" }\ntask t like plain { scene clad }\n'),
    "object: colour": ("an object of another colour", "object red_carrot like carrot { paint red; color red }\ntask t like plain { source red_carrot }\n"),
    "object: texture": ("an object of another texture", 'object wooden like carrot { texture "wood" }\ntask t like plain { source wooden }\n'),
    "object: size": ("an object of another size", "object big like carrot { scale 1.2 }\ntask t like plain { source big }\n"),
    "object: mass": ("an object of another mass or friction", "object heavy like carrot { density 1400kg/m3; friction 0.8 }\ntask t like plain { source heavy }\n"),
    "soft things": ("ropes, dirt that is wiped off", None),
}
