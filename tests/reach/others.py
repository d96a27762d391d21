"""The same of tasks that are not BDDL files."""
import json
import re

PLUS = {  # categories of LIBERO-plus
    "Sensor Noise": {"sensor"}, "Camera Viewpoints": {"camera"}, "Robot Initial States": {"start: robot"},
    "Language Instructions": {"words"}, "Objects Layout": {"more objects", "start: from a file"},
    "Light Conditions": {"light", "light: colour"}, "Background Textures": {"texture: surface", "texture: walls"}}

COLOSSEUM = {  # variations of COLOSSEUM
    "object_color": "object: colour", "object_texture": "object: texture", "object_size": "object: size", "light_color": "light: colour",
    "table_color": "texture: surface", "table_texture": "texture: surface", "distractor_object": "more objects",
    "background_texture": "texture: walls", "object_friction": "object: mass", "object_mass": "object: mass", "camera_pose": "camera"}


def plus_tasks(path, base_keys):
    """(name, keys) of each perturbed task; `base_keys` knows those of the task that it perturbs."""
    with open(path) as file:
        for suite, tasks in json.load(file).items():
            for task in tasks:
                yield suite, task["name"], base_keys(suite, task["name"]) | PLUS[task["category"]]


def colosseum_keys(source, variations):
    """Of a task's class and its table of variations."""
    found = set()
    if "DetectedCondition" in source:
        found.add("goal: in a place")
        if "negated=True" in source:
            found.add("goal: negated")
    if "GraspedCondition" in source or "NothingGrasped" in source:
        found.add("goal: held")
    if "JointCondition" in source:
        found.add("goal: opened")
    if "EmptyCondition" in source or re.search(r"\brope\b", source, re.IGNORECASE):
        found.add("soft things")
    if len(re.findall(r"(?:Detected|Grasped|Joint|Empty)Condition\(|NothingGrasped\(", source)) > 1:
        found.add("goal: several")
    if not found:
        found.add("unknown: no condition")
    for variation in variations:
        found.add(COLOSSEUM[variation])
    return found


def google_keys(name):
    """Of a name of SimplerEnv's Google robot."""
    if "pick" in name:
        return {"goal: lifted", "start: from a file"}
    if "move_near" in name:
        return {"goal: near", "goal: several", "start: from a file", "more objects"}
    if "open" in name:
        return {"goal: opened", "start: joints"}
    if "place" in name:
        return {"goal: opened", "goal: touching", "goal: several", "words: two, one after the other", "start: from a file"}
    return {"goal: closed", "start: joints"}
