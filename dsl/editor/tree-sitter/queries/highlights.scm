;; Colours of Probe. No node is captured twice, so that editors in which the first pattern wins agree with those in which
;; the last does; tests/dsl/tree_sitter holds them to the colours that `vlaprobe lsp` gives.

(comment) @comment
(doc_comment) @comment.documentation

;; ---- words ----
[
  "a" "absent" "abstract" "against" "air" "all" "allow" "along" "always" "ambient" "among" "angle" "answer" "any"
  "area" "arm_path" "armature" "around" "as" "at" "attribute" "avoid" "axis" "backdrop" "bare" "baselines" "beside"
  "blur" "body" "both" "box" "by" "camera" "cameras" "catalogue" "cells" "choice" "clear" "close" "clutter" "color" "com"
  "control" "count" "cutoff" "damping" "dataset" "delay" "density" "derive" "direction" "disc" "distinct" "distractors" "drive" "drop"
  "dropped" "end" "ends" "episodes" "expect" "exponent" "exposure" "extend" "facts" "fade" "final" "fingers" "first"
  "fixture" "fixtures" "for" "frame" "free" "friction" "from" "grid" "grip" "grip_path" "has" "headlight" "home" "horizon"
  "idle" "image" "impulse" "in" "inertia" "is" "jitter" "joint" "joints" "kp" "layout" "left" "length" "lens"
  "light" "lights" "like" "limit" "link" "look" "loop" "mass" "max" "maybe" "means" "mentions" "mesh" "metrics"
  "min" "mirrored" "most" "mount" "moves" "name" "nearer" "no" "noise" "none" "null" "number" "object" "objects"
  "occlusion" "of" "on" "once" "ood" "open" "opens" "orient" "other" "output" "overlay" "pace" "paint" "part"
  "parts" "patch" "phrase" "phrases" "physics" "pick" "pitch" "pixels" "place" "point" "points" "pose" "power"
  "predicate" "prefix" "present" "press" "push" "put" "quat" "questions" "ramp" "reach" "refer" "region" "relation"
  "relations" "remaining" "rest" "robot" "robots" "role" "roll" "sample" "samples" "say" "scale" "scene" "scenes" "seed"
  "seeds" "seen" "sensor" "set" "settle" "shading" "shadow" "solution" "source" "specular" "spot" "spread" "stands"
  "space" "start" "starts" "stay" "step" "steps" "stiffness" "suite" "sun" "surface" "target" "task" "tasks" "tcp"
  "template" "templates" "texture" "the" "then" "time" "times" "to" "trained" "turn" "uncouple" "unseen" "urdf" "use"
  "uses" "variant" "variants" "vertex" "viscosity" "when" "where" "whole" "window" "with" "within" "words" "x" "yaw" "yesno"
] @keyword
["and" "or" "not"] @keyword.operator
(object_phrase axis: (identifier) @keyword)
(part_phrase axis: (identifier) @keyword)

;; ---- numbers and strings ----
[(integer) (float)] @number
(unit) @type.builtin
(unknown_unit) @error
[(text) "\""] @string
(escape) @string.escape
(slot ["{" "}"] @punctuation.special)
(slot name: (identifier) @variable.parameter)
(slot part: (identifier) @property)
(slot category: (identifier) @constant)
(number_word) @number
(placeholder ["{" "}"] @punctuation.special)
(placeholder name: (identifier) @variable.parameter)
(placeholder of: (identifier) @variable.parameter)

;; ---- what is declared ----
(dataset_declaration name: (identifier) @type)
(object_declaration name: (identifier) @type)
(extend_declaration object: (identifier) @type)
(robot_declaration name: (identifier) @type)
(camera_declaration name: (identifier) @type)
(light_declaration name: (identifier) @type)
(fixture_declaration name: (identifier) @type)
(scene_declaration name: (identifier) @type)
(layout_declaration name: (identifier) @type)
(metrics_declaration name: (identifier) @type)
(task_declaration name: (identifier) @type)
(variant_declaration name: (identifier) @type)
(member name: (identifier) @type)
(set_declaration name: (identifier) @type)
(questions_declaration name: (identifier) @type)
(suite_declaration name: (identifier) @type)
(space_declaration name: (identifier) @type)
(_ like: (identifier) @type)
(_ against: (identifier) @type)
(variant_declaration of: (identifier) @type)
(variants_declaration of: (identifier) @type)
(suite_declaration trained_on: (identifier) @type)
(template_declaration name: (identifier) @function.macro)
(template_declaration frame: (identifier) @function.macro)
(predicate_declaration name: (identifier) @function)
(relation_declaration name: (identifier) @function)
(call function: (identifier) @function)
(relation_query relation: (identifier) @function)
(role_declaration name: (identifier) @variable)
(task_refer role: (identifier) @variable)
(role role: (identifier) @variable)

;; ---- names that hold for a while ----
(parameter name: (identifier) @variable.parameter)
(argument name: (identifier) @variable.parameter)
(quantified variable: (identifier) @variable.parameter)
(binder name: (identifier) @variable.parameter)
(_ binder: (identifier) @variable.parameter)

;; ---- what things have ----
(attribute_declaration name: (identifier) @property)
(attribute attribute: (identifier) @property)
(fact . (identifier) @property value: (identifier) @constant)
(fact . (identifier) @constant .)
(attribute value: (identifier) @constant)
(attribute_declaration (name_set (identifier) @constant))
(facts_declaration (name_set (identifier) @constant))
(object_is (identifier) @constant)
(object_maybe (identifier) @constant)
(part_is (identifier) @constant)
(part_maybe (identifier) @constant)
(metric name: (identifier) @property)
(layout_cells name: (identifier) @property)
(layout_place cells: (identifier) @property)
(member_of member: (identifier) @property)
(view as: (identifier) @property)
(task_camera as: (identifier) @property)
(fixture_part name: (identifier) @property)
(fixture_region name: (identifier) @property)
(object_region name: (identifier) @property)
(scene_region name: (identifier) @property)
(questions_choice name: (identifier) @property)
(questions_yesno name: (identifier) @property)
(questions_number name: (identifier) @property)
(questions_point name: (identifier) @property)
(questions_free name: (identifier) @property)
(object_phrase name: (identifier) @label)
(part_phrase name: (identifier) @label)
(task_refer phrase: (identifier) @label)
(clear_phrase phrase: (identifier) @label)

;; ---- signs ----
["=" "<" "<=" ">" ">=" "==" "!=" "+" "-" "*" "/" "|" "&" ".."] @operator
["(" ")"] @punctuation.bracket
["," ";" ":" "."] @punctuation.delimiter
"@" @punctuation.special
