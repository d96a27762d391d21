#include "runtime/store/unproven_table.h"

namespace probe::store {

Status UnprovenTable::make() {
  return database_.execute(
      "create table if not exists unproven (task text not null, episode integer not null, seed "
      "integer not null, primary key (task, episode, seed)) without rowid");
}

Status UnprovenTable::add(const EpisodeKey& key) {
  Statement insert(database_, "insert or replace into unproven values (?, ?, ?)",
                   Database::Access::kWrite);
  insert.bind(key.task).bind(key.episode).bind(key.seed).next();
  return insert.done();
}

Status UnprovenTable::remove(const EpisodeKey& key) {
  Statement erase(database_, "delete from unproven where task = ? and episode = ? and seed = ?",
                  Database::Access::kWrite);
  erase.bind(key.task).bind(key.episode).bind(key.seed).next();
  return erase.done();
}

Result<std::vector<EpisodeKey>> UnprovenTable::valid() {
  std::vector<EpisodeKey> keys;
  PROBE_ASSIGN(const bool has_table, is_there());
  if (!has_table) return keys;
  Statement select(database_,
                   "select task, episode, seed from unproven natural join episodes where invalid "
                   "is null order by task, episode, seed");
  while (select.next()) keys.push_back({select.text(0), select.number(1), select.number(2)});
  PROBE_TRY(select.done());
  return keys;
}

Status UnprovenTable::clear() {
  PROBE_ASSIGN(const bool has_table, is_there());
  return has_table ? database_.execute("delete from unproven") : Status();
}

Result<bool> UnprovenTable::is_there() {
  Statement table(database_, "select 1 from sqlite_master where name = 'unproven'");
  const bool found = table.next();
  PROBE_TRY(table.done());
  return found;
}

}  // namespace probe::store
