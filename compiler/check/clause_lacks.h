// What success lacks of one clause, construct by construct: why it does not fit, to stand behind
// "says .. and"; nothing where it fits or nothing is certain.
#pragma once

#include <optional>
#include <string>

#include "compiler/check/clause_facts.h"
#include "compiler/check/clauses.h"

namespace probe::sema {

using Lack = std::optional<std::string>;

Lack put_lack(const ClauseFacts& facts, const Clause& clause);
// "put the cube but not the can on the tray" of which success wants the can there, too.
Lack spared_lack(const ClauseFacts& facts, const Clause& clause);

// "take the cube off the tray" of which success is that it is there, and no later clause puts it
// back.
Lack from_lack(const ClauseFacts& facts, const Clause& clause);
// "put the cube on the table" of which success wants it to lie on the tray.
Lack ground_lack(const ClauseFacts& facts, const Clause& clause);
// "put the cube on the tray, then pick it up again" of which success is that it lies there at the
// end.
Lack taken_lack(const ClauseFacts& facts, const Clause& clause);
// "take the cube out of the drawer" of one that begins elsewhere.
Lack begun_lack(const ClauseFacts& facts, const Clause& clause);
// "lift the cube" of which success is that the hand is closed.
Lack idle_lack(const ClauseFacts& facts, const Clause& clause);
// "touch the cube", "put it back down" of which success wants it to be higher than it began.
Lack raised_lack(const ClauseFacts& facts, const Clause& clause);
// "pick up the cube", "touch the cube" and no more, of which success wants it to lie on the tray.
Lack place_left_out(const ClauseFacts& facts);

// "both cubes" of which success asks the same of three.
Lack count_lack(const ClauseFacts& facts, const Clause& clause);
// "open all drawers" of which success is that one is open; "one of the drawers" where it asks for
// all of them, or for a certain one; "the cube and the can" where either will do.
Lack quantity_lack(const ClauseFacts& facts, const Clause& clause);

// "open the drawer and close it" of which success asks that it is open, or nothing of it.
Lack joint_lack(const ClauseFacts& facts, const Clause& clause, const Clause::What& what);

// "do not put the cube on the tray" of which success is that it is there.
Lack denied_lack(const ClauseFacts& facts, const Clause& clause);

// "without lifting it", "leave the cube alone" of which success is just that.
Lack left_lack(const ClauseFacts& facts, const Clauses::Left& left);

// "the cube last" of which success wants the cube first.
Lack rank_lack(const ClauseFacts& facts, const Rank& rank);

}  // namespace probe::sema
