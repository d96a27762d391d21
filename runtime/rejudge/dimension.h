// What the registers of a program measure, and numbers with the units people read. For texts only:
// nothing here decides a verdict.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "runtime/plan/plan.h"

namespace probe::rejudge {

enum class Dimension : std::uint8_t {
  kAny,  // a constant, which takes the dimension of what it meets
  kNumber,
  kLength,
  kAngle,
  kImpulse,
  kSpeed,
  kSpin,
  kTime,
  kSteps,
  kOther  // products of the above
};

// By register of the program.
std::vector<Dimension> dimensions_of(const plan::Plan& plan, const plan::ProgramRecord& program);

// By metric of the program: what its number measures; a truth is a number.
std::vector<Dimension> metric_dimensions(const plan::Plan& plan,
                                         const plan::ProgramRecord& program);

// "3.1cm", "1.2m", "0.004Ns", "12cm/s", "60deg" (radians in), "0.8s", "14", to three digits.
std::string quantity(double value, Dimension dimension, int digits = 3);
std::string angle_text(double radians, int digits = 3);

// Both sides of a comparison, with as many digits as it takes to see which is larger.
std::pair<std::string, std::string> quantities(double a, double b, Dimension dimension);

}  // namespace probe::rejudge
