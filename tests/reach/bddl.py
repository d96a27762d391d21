"""What a BDDL file's task is made of, in the keys of constructs.py."""
import re

GOALS = {"On": "on", "NotOn": "not on", "In": "in", "Open": "opened", "Close": "closed", "Turnon": "turned", "Turnoff": "turned",
         "InContact": "goal: touching", "CheckDistance": "goal: distance"}
COSTS = {"CheckGripperContact": "cost: touched", "CheckGripperDistance": "cost: near the gripper",
         "CheckGripperDistancePart": "cost: part near the gripper", "Fall": "cost: fell", "InContact": "goal: touching",
         "CheckDistance": "goal: distance", "On": "goal: on an object", "In": "goal: in a place", "NotOn": "goal: negated"}


def parse(text):
    tokens = re.findall(r"[()]|[^\s()]+", re.sub(r";.*", "", text))
    stack = [[]]
    for token in tokens:
        if token == "(":
            stack.append([])
        elif token == ")":
            done = stack.pop()
            stack[-1].append(done)
        else:
            stack[-1].append(token)
    return stack[0][0]


def section(tree, name):
    return next((part[1:] for part in tree if isinstance(part, list) and part and part[0] == name), [])


def names(tree, name):
    """Of `a b - kind c - other`."""
    return {word for word in section(tree, name) if word != "-"}


def facts(condition):
    """Conditions without their And; a Not is told."""
    if condition[0] == "And":
        for part in condition[1:]:
            if isinstance(part, list):
                yield from facts(part)
    elif condition[0] == "Not":
        yield ["Not"]
        yield from facts(condition[1])
    else:
        yield condition


def goal_keys(fact, objects):
    kind = fact[0]
    if kind == "Not":
        return {"goal: negated"}
    if kind in ("On", "NotOn"):
        on = "goal: on an object" if fact[2] in objects else "goal: on a place"
        return {on, "goal: negated"} if kind == "NotOn" else {on}
    if kind == "In":
        owner = next((o for o in objects if fact[2].startswith(o)), None)
        return {"goal: in an object" if owner else "goal: in a place"}
    if kind in ("Open", "Close", "Turnon", "Turnoff"):
        return {"goal: " + GOALS[kind]}
    if kind in COSTS:
        return {COSTS[kind]}
    return {"unknown: " + kind}


def start_keys(fact, objects):
    kind = fact[0]
    if kind == "On":
        return {"start: on an object" if fact[2] in objects else "start: on the table"}
    if kind == "In":
        return {"start: in a place"}
    if kind in ("Open", "Close", "Turnon", "Turnoff"):
        return {"start: joints"}
    return {"unknown: " + kind}


def keys_of(text):
    tree = parse(text)
    objects = names(tree, ":objects")
    goals = [f for part in section(tree, ":goal") for f in facts(part)]
    found = set()
    for fact in goals:
        found |= goal_keys(fact, objects)
    if len(goals) > 1:
        found.add("goal: several")
    for fact in section(tree, ":init"):
        found |= start_keys(fact, objects)
    for part in section(tree, ":cost"):
        found.add("cost: over time")
        for fact in facts(part):
            found |= {COSTS[fact[0]]} if fact[0] in COSTS else goal_keys(fact, objects)
    for kind in re.findall(r":motion_type\s+(\w+)", text):
        found.add("start: moving along a line" if kind == "linear" else "start: moving round or by points")
    return found
