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
  // The model whose collision mesh stands for it where it has none.
  std::string_view felt_as = "";
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

// The same for suite/google.probe, whose cans and orange are of double size. 7up, Sprite and Fanta
// are painted cans there; the baked ones, which shine, are visual matching's.
inline constexpr std::array kGoogleModels{
    KnownModel{"opened_coke_can", "objects/coke_can", 0.5},
    KnownModel{"opened_pepsi_can", "objects/pepsi_can", 0.5},
    KnownModel{"opened_redbull_can", "objects/slim_can", 1},
    KnownModel{"blue_plastic_bottle", "objects/water_bottle", 1},
    KnownModel{"apple", "objects/apple", 1},
    KnownModel{"orange", "objects/orange", 0.5},
    KnownModel{"sponge", "objects/long_sponge", 1},
    KnownModel{"bridge_spoon_generated_modified", "objects/spoon", 1},
    KnownModel{"bridge_carrot_generated_modified", "objects/carrot", 1},
    KnownModel{"eggplant", "objects/eggplant", 1},
    KnownModel{"green_cube_3cm", "objects/green_cube", 1},
    KnownModel{"yellow_cube_3cm", "objects/yellow_cube", 1},
    KnownModel{"baked_opened_coke_can", "objects/baked_coke_can", 0.5, "opened_coke_can"},
    KnownModel{"baked_opened_pepsi_can", "objects/baked_pepsi_can", 0.5, "opened_pepsi_can"},
    KnownModel{"baked_opened_7up_can", "objects/baked_7up_can", 0.5, "opened_7up_can"},
    KnownModel{"baked_opened_redbull_can", "objects/baked_slim_can", 1, "opened_redbull_can"},
    KnownModel{"baked_sponge", "objects/baked_long_sponge", 1, "sponge"},
    KnownModel{"baked_apple", "objects/baked_apple", 1, "apple"},
    KnownModel{"baked_apple_v2", "objects/baked_apple_v2", 1, "apple"},
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
inline constexpr int kBridgeWidth = 640, kBridgeHeight = 480;  // of the camera's picture, pixels

// Pictures that suite/google/photos.probe puts behind its scenes, below scenes/google. They are of
// half the camera's size.
inline constexpr std::array<std::string_view, 11> kGooglePhotos{
    "google_coke_can_real_eval_1.png", "google_move_near_real_eval_1.png", "open_drawer_a0.png",
    "open_drawer_a1.png",              "open_drawer_a2.png",               "open_drawer_b0.png",
    "open_drawer_b1.png",              "open_drawer_b2.png",               "open_drawer_c0.png",
    "open_drawer_c1.png",              "open_drawer_c2.png"};
inline constexpr int kGoogleWidth = 640, kGoogleHeight = 512;  // of the camera's picture, pixels

// The Google robot and its colourings, below robots/google_released: descriptions in the release.
struct KnownRobot {
  std::string_view file;  // of the release
  std::string_view name;
  bool is_colouring = true;  // its meshes are told from the plain one's by their textures
};
inline constexpr std::array kGoogleRobots{
    KnownRobot{"google_robot_meta_sim_fix_wheel_fix_fingertip.urdf", "google_robot", false},
    KnownRobot{
        "google_robot_meta_sim_fix_wheel_fix_fingertip_recolor_tabletop_visual_matching_1.urdf",
        "google_robot_tabletop_1"},
    KnownRobot{
        "google_robot_meta_sim_fix_wheel_fix_fingertip_recolor_tabletop_visual_matching_2.urdf",
        "google_robot_tabletop_2"},
    KnownRobot{
        "google_robot_meta_sim_fix_wheel_fix_fingertip_recolor_cabinet_visual_matching_1.urdf",
        "google_robot_cabinet_1"},
};

// What suite/google.probe is written for and no release has in that form.
inline constexpr std::array<std::string_view, 5> kGoogleOwn{
    "robots/google_robot", "fixtures/google_station", "scenes/google_table", "scenes/google_room",
    "textures"};

// Stages have y up. The reference turns them by 90 degrees about x and moves them by this, metres
// (mani_skill2_real2sim/envs/custom_scenes/base_env.py).
inline constexpr std::array<double, 3> kStageOffset{2.0634, 2.8313, 0};

}  // namespace probe::assets
