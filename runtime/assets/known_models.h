// Which of the published models the suite's assets stand for. Names on the left are those of
// SimplerEnv's and INT-ACT's data folders, on the right the folders of this repository's assets.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace probe::assets {

struct KnownModel {
  std::string_view id;  // folder below data/custom/models
  std::string_view folder;
  double scale;  // the suite's tasks use the model at this size
};

// The scales are those of the INT-ACT tasks.
inline constexpr std::array kKnownModels{
    KnownModel{"bridge_carrot_generated_modified", "objects/carrot", 1},
    KnownModel{"bridge_plate_objaverse_larger", "objects/plate", 1},
    KnownModel{"bridge_plate_objaverse_smaller", "objects/small_plate", 1},
    KnownModel{"bridge_spoon_generated_modified", "objects/spoon", 1},
    KnownModel{"table_cloth_generated_shorter", "objects/towel", 1},
    KnownModel{"baked_green_cube_3cm", "objects/green_cube", 1},
    KnownModel{"baked_yellow_cube_3cm", "objects/yellow_cube", 1},
    KnownModel{"eggplant", "objects/eggplant", 1},
    KnownModel{"dummy_sink_target_plane", "objects/basket", 1},
    KnownModel{"coke_can", "objects/coke_can", 0.5},
    KnownModel{"pepsi_can", "objects/pepsi_can", 0.5},
    KnownModel{"orange_juice", "objects/orange_juice", 0.5},
    KnownModel{"nut", "objects/nut", 1},
    KnownModel{"keyboard_smaller", "objects/keyboard", 1},
    KnownModel{"ramekin", "objects/ramekin", 1.25},
    KnownModel{"wheel", "objects/wheel", 1.25},
    KnownModel{"sponge_larger", "objects/sponge", 1},
    KnownModel{"sponge", "objects/half_sponge", 0.5},
    KnownModel{"rabbit", "objects/rabbit", 1},
    KnownModel{"orange", "objects/orange", 0.5},
    KnownModel{"sink", "fixtures/sink", 1},
};

// The target plane in the sink: it is felt and never drawn, the photo shows the basket.
inline constexpr std::string_view kUnseenModel = "dummy_sink_target_plane";

struct KnownScene {
  std::string_view name;   // folder below scenes
  std::string_view photo;  // file below data/real_inpainting
  std::string_view stage;  // file below data/hab2_bench_assets/stages
};
inline constexpr std::array kKnownScenes{
    KnownScene{"table", "bridge_real_eval_1.png", "bridge_table_1_v1.glb"},
    KnownScene{"sink", "bridge_sink.png", "bridge_table_1_v2.glb"},
};

// Stages have y up. The reference turns them by 90 degrees about x and moves them by this, metres
// (mani_skill2_real2sim/envs/custom_scenes/base_env.py).
inline constexpr std::array<double, 3> kStageOffset{2.0634, 2.8313, 0};

}  // namespace probe::assets
