#include "runtime/store/calls_table.h"

namespace probe::store {

Status CallsTable::write(const std::string& text) {
  if (own_ == 0) {
    PROBE_ASSIGN(own_, next());
  }
  return put(own_, text);
}

Status CallsTable::add(const std::string& text) {
  PROBE_ASSIGN(const int number, next());
  return put(number, text);
}

Result<int> CallsTable::next() {
  int number = 0;
  Statement last(database_, "select coalesce(max(number), 0) from calls");
  if (last.next()) number = last.number(0) + 1;
  PROBE_TRY(last.done());
  return number;
}

Status CallsTable::put(int number, const std::string& text) {
  Statement insert(database_, "insert or replace into calls values (?, ?)",
                   Database::Access::kWrite);
  insert.bind(number).bind(text).next();
  return insert.done();
}

}  // namespace probe::store
