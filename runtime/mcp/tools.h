// What a coding agent may ask of this program, by the Model Context Protocol's `tools`: each a verb
// with --json, called as a user would, so that an agent is told what a user is. One table says name,
// words, arguments and answer; schemas and checks are made from it.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "runtime/base/json.h"

namespace probe::mcp {

class Tools {
 public:
  // `program`: path of vlaprobe.
  static std::unique_ptr<Tools> make(std::string program);
  // Ends what `run` began and what has not ended; it continues when it is asked for again.
  virtual ~Tools() = default;

  // `tools` of the answer to tools/list.
  virtual Json list() const = 0;
  virtual bool has(std::string_view name) const = 0;
  // The result of tools/call. Arguments that do not fit the tool's schema, and what the verb
  // refuses, are results with `isError`: agents read them.
  virtual Json call(std::string_view name, const Json& arguments) = 0;
};

}  // namespace probe::mcp
