#include "runtime/robot/urdf_limits.h"

#include <tinyxml.h>

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

namespace probe::robot {
namespace {

// -1 of `-inf`, 1 of `inf`, in any of C's spellings; 0 of all else, a number too large among it.
int infinite_sign(const TiXmlElement& limit, const char* end) {
  const char* const text = limit.Attribute(end);
  if (text == nullptr || std::strpbrk(text, "iI") == nullptr) return 0;
  char* rest = nullptr;
  const double value = std::strtod(text, &rest);
  while (std::isspace(static_cast<unsigned char>(*rest))) ++rest;
  if (*rest != '\0' || !std::isinf(value)) return 0;
  return value < 0 ? -1 : 1;
}

}  // namespace

Result<std::string> without_infinite_limits(const std::string& text, const std::string& path) {
  TiXmlDocument document;
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  TiXmlElement* const robot = document.RootElement();
  if (robot == nullptr) return text;
  bool is_changed = false;
  for (TiXmlElement* e = robot->FirstChildElement("joint"); e; e = e->NextSiblingElement("joint")) {
    TiXmlElement* const limit = e->FirstChildElement("limit");
    if (limit == nullptr) continue;
    const int lower = infinite_sign(*limit, "lower"), upper = infinite_sign(*limit, "upper");
    if (lower == 0 && upper == 0) continue;
    const std::string type = e->Attribute("type");
    const bool turns = type == "revolute";
    if (turns && lower < 0 && upper > 0) {
      e->SetAttribute("type", "continuous");
    } else if (turns || type == "prismatic") {
      return Failure{Fault::kUrdf,
                     fmt::format("joint `{}` goes from `{}` to `{}`: {}", e->Attribute("name"),
                                 limit->Attribute("lower"), limit->Attribute("upper"),
                                 turns ? "both are numbers, or `-inf` and `inf` of what turns "
                                         "without end"
                                       : "of what slides both are numbers"),
                     fmt::format("{}:{}", path, limit->Row())};
    }
    limit->RemoveAttribute("lower");
    limit->RemoveAttribute("upper");
    is_changed = true;
  }
  if (!is_changed) return text;
  TiXmlPrinter printer;
  document.Accept(&printer);
  return std::string(printer.CStr());
}

}  // namespace probe::robot
