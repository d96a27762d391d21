// How the values of a profile's fields are written. For profile.cpp, which reads and writes them.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/servers/profile.h"

namespace probe::servers {

template <typename E>
struct Word {
  std::string_view text;
  E value;
};

inline constexpr std::array kResizes = {
    Word<Resize>{"none", Resize::kNone},        Word<Resize>{"stretch", Resize::kStretch},
    Word<Resize>{"pad", Resize::kPad},          Word<Resize>{"crop", Resize::kCrop},
    Word<Resize>{"lanczos", Resize::kLanczos},  Word<Resize>{"cv2_linear", Resize::kCv2Linear},
    Word<Resize>{"cv2_area", Resize::kCv2Area}, Word<Resize>{"tf_lanczos3", Resize::kTfLanczos3},
};
// Of an image: through JPEG first.
inline constexpr std::string_view kThroughJpeg = "jpeg95";
inline constexpr std::array kPixelLayouts = {
    Word<PixelLayout>{"hwc_u8", PixelLayout::kHwcU8},
    Word<PixelLayout>{"chw_f32", PixelLayout::kChwF32},
};
inline constexpr std::array kStateLayouts = {
    Word<StateLayout>{"none", StateLayout::kNone},
    Word<StateLayout>{"xyz_wxyz_openness", StateLayout::kXyzWxyzOpenness},
    Word<StateLayout>{"xyz_rpy_openness", StateLayout::kXyzRpyOpenness},
    Word<StateLayout>{"xyz_rpy_pad_openness", StateLayout::kXyzRpyPadOpenness},
    Word<StateLayout>{"xyz_rotvec_openness", StateLayout::kXyzRotvecOpenness},
    Word<StateLayout>{"xyz_xyzw_closedness", StateLayout::kXyzXyzwClosedness},
    Word<StateLayout>{"xyz_rotvec_fingers", StateLayout::kXyzRotvecFingers},
    Word<StateLayout>{"joints", StateLayout::kJoints},
    Word<StateLayout>{"joints_openness", StateLayout::kJointsOpenness},
    Word<StateLayout>{"arm_joints", StateLayout::kArmJoints},
    Word<StateLayout>{"fingers", StateLayout::kFingers},
    Word<StateLayout>{"openness", StateLayout::kOpenness},
    Word<StateLayout>{"closedness", StateLayout::kClosedness},
    Word<StateLayout>{"libero", StateLayout::kLibero},
};
inline constexpr std::array kStateFrames = {
    Word<StateFrame>{"base", StateFrame::kBase},
    Word<StateFrame>{"top_down", StateFrame::kTopDown},
};
inline constexpr std::array kNumberTypes = {
    Word<NumberType>{"f32", NumberType::kF32},
    Word<NumberType>{"f64", NumberType::kF64},
};
inline constexpr std::array kNormalisations = {
    Word<Normalisation>{"none", Normalisation::kNone},
    Word<Normalisation>{"bound", Normalisation::kBound},
    Word<Normalisation>{"gaussian", Normalisation::kGaussian},
};
inline constexpr std::array kRotations = {
    Word<RotationForm>{"unsaid", RotationForm::kUnsaid},
    Word<RotationForm>{"vector", RotationForm::kVector},
    Word<RotationForm>{"euler", RotationForm::kEuler},
};
inline constexpr std::array kActionForms = {
    Word<ActionForm>{"unsaid", ActionForm::kUnsaid},
    Word<ActionForm>{"delta", ActionForm::kDelta},
    Word<ActionForm>{"absolute", ActionForm::kAbsolute},
    Word<ActionForm>{"joints", ActionForm::kJoints},
    Word<ActionForm>{"joint_steps", ActionForm::kJointSteps},
};
inline constexpr std::array kActionUnits = {
    Word<ActionUnits>{"unsaid", ActionUnits::kUnsaid},
    Word<ActionUnits>{"m_rad", ActionUnits::kMetric},
    Word<ActionUnits>{"box", ActionUnits::kBox},
    Word<ActionUnits>{"ball", ActionUnits::kBall},
};
inline constexpr std::array kGrippers = {
    Word<GripperRange>{"signed", GripperRange::kSigned},
    Word<GripperRange>{"unit", GripperRange::kUnit},
    Word<GripperRange>{"signed_inverted", GripperRange::kSignedInverted},
    Word<GripperRange>{"unit_inverted", GripperRange::kUnitInverted},
    Word<GripperRange>{"step", GripperRange::kStep},
    Word<GripperRange>{"step_inverted", GripperRange::kStepInverted},
};
inline constexpr std::array kStickyRules = {
    Word<StickyRule>{"none", StickyRule::kNone},
    Word<StickyRule>{"last", StickyRule::kLast},
    Word<StickyRule>{"switch", StickyRule::kSwitch},
    Word<StickyRule>{"half", StickyRule::kHalf},
};
inline constexpr std::array kCases = {
    Word<PromptCase>{"as_is", PromptCase::kAsIs},
    Word<PromptCase>{"lower", PromptCase::kLower},
};
inline constexpr std::array kFullStops = {
    Word<FullStop>{"as_is", FullStop::kAsIs},
    Word<FullStop>{"without", FullStop::kWithout},
    Word<FullStop>{"with", FullStop::kWith},
};
inline constexpr std::array kEnsembles = {
    Word<Ensemble>{"none", Ensemble::kNone},
    Word<Ensemble>{"temporal", Ensemble::kTemporal},
};

inline constexpr std::array kConnections = {
    Word<ConnectionUse>{"kept", ConnectionUse::kKept},
    Word<ConnectionUse>{"per_episode", ConnectionUse::kPerEpisode},
};
inline constexpr std::array kCheckpoints = {
    Word<CheckpointUse>{"named", CheckpointUse::kNamed},
    Word<CheckpointUse>{"ignored", CheckpointUse::kIgnored},
};
inline constexpr std::array kWorlds = {
    Word<WorldsAtOnce>{"many", WorldsAtOnce::kMany},
    Word<WorldsAtOnce>{"one", WorldsAtOnce::kOne},
};

constexpr std::span<const Word<Resize>> words_of(Resize) { return kResizes; }
constexpr std::span<const Word<PixelLayout>> words_of(PixelLayout) { return kPixelLayouts; }
constexpr std::span<const Word<StateLayout>> words_of(StateLayout) { return kStateLayouts; }
constexpr std::span<const Word<StateFrame>> words_of(StateFrame) { return kStateFrames; }
constexpr std::span<const Word<NumberType>> words_of(NumberType) { return kNumberTypes; }
constexpr std::span<const Word<Normalisation>> words_of(Normalisation) { return kNormalisations; }
constexpr std::span<const Word<RotationForm>> words_of(RotationForm) { return kRotations; }
constexpr std::span<const Word<ActionForm>> words_of(ActionForm) { return kActionForms; }
constexpr std::span<const Word<ActionUnits>> words_of(ActionUnits) { return kActionUnits; }
constexpr std::span<const Word<GripperRange>> words_of(GripperRange) { return kGrippers; }
constexpr std::span<const Word<StickyRule>> words_of(StickyRule) { return kStickyRules; }
constexpr std::span<const Word<PromptCase>> words_of(PromptCase) { return kCases; }
constexpr std::span<const Word<FullStop>> words_of(FullStop) { return kFullStops; }
constexpr std::span<const Word<Ensemble>> words_of(Ensemble) { return kEnsembles; }
constexpr std::span<const Word<ConnectionUse>> words_of(ConnectionUse) { return kConnections; }

constexpr std::span<const Word<CheckpointUse>> words_of(CheckpointUse) { return kCheckpoints; }

constexpr std::span<const Word<WorldsAtOnce>> words_of(WorldsAtOnce) { return kWorlds; }

// Protocols have theirs in their rows.
inline std::vector<Word<Protocol>> words_of(Protocol) {
  std::vector<Word<Protocol>> words;
  for (const Protocol protocol : all_protocols()) words.push_back({to_word(protocol), protocol});
  return words;
}

template <typename E>
std::string_view word_of(E value) {
  for (const auto& word : words_of(E{})) {
    if (word.value == value) return word.text;
  }
  return "";
}

}  // namespace probe::servers
