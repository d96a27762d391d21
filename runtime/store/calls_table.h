// What each call that wrote into a folder did, as a text with a number: the table that folders of
// episodes and of answers have alike.
#pragma once

#include <string>
#include <string_view>

#include "runtime/store/database.h"

namespace probe::store {

inline constexpr std::string_view kCallColumns[] = {"number", "value"};
inline constexpr const char* kCallsSchema =
    "create table if not exists calls (number integer primary key, value text not null);";

class CallsTable {
 public:
  explicit CallsTable(Database& database) : database_(database) {}  // which must live as long

  // Of this call; each text replaces the one before.
  Status write(const std::string& text);
  // Of another one, behind all that are there.
  Status add(const std::string& text);

 private:
  Result<int> next();
  Status put(int number, const std::string& text);

  Database& database_;
  int own_ = 0;  // 0: not written yet
};

}  // namespace probe::store
