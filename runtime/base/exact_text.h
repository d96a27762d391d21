// Numbers as texts that read back as the same bits.
#pragma once

#include <cstdio>
#include <string>

namespace probe {

// 17 significant digits, as many as any double needs.
inline std::string exact_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

}  // namespace probe
