;; What an editor can fold: declarations with a block, and blocks of tasks inside of them.
[
  (dataset_declaration) (object_declaration) (extend_declaration) (robot_declaration) (camera_declaration)
  (light_declaration) (fixture_declaration) (scene_declaration) (layout_declaration) (metrics_declaration)
  (task_declaration) (variant_declaration) (variants_declaration) (derive_declaration) (questions_declaration)
  (suite_declaration)
  (space_declaration)
  (member) (robot_control) (fixture_part) (task_solution) (condition_block)
] @fold
