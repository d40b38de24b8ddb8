// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/map_store.hpp"

#include "store/facts.hpp"
#include "store/first_version.hpp"
#include "store/leg_rows.hpp"
#include "store/memory_rows.hpp"
#include "store/store_file.hpp"
#include "store/store_tables.hpp"

#include <stdexcept>
#include <system_error>
#include <utility>

namespace trussmap {
using namespace store;

namespace {

namespace fs = std::filesystem;

}  // namespace

class __attribute__((visibility("hidden"))) MapStore::Impl {
 public:
  /// `first`: what a new store begins with; null: with nothing, or go on.
  Impl(const fs::path& file, const std::optional<MapBuilderOptions>& options,
       const MapBuilderOptions& if_new, const MapBuilder* first)
      : file_(file),
        lock_(lock_store(file)),
        fresh_(place_of_store(file)),
        database_(open(first != nullptr)) {
    database_.run("BEGIN IMMEDIATE");
    if (!is_store(file_, database_)) {
      create_store(database_, options.value_or(if_new));
      if (first != nullptr) {
        MemoryRows(database_).save(BuilderAccess::settled_memory(*first), first->options());
      }
    } else if (is_of_first_version(database_)) {
      upgrade_first_version(database_);
    }
    database_.run("COMMIT");
    rows_.emplace(database_);
    facts_.emplace(database_);
    put_leg_.emplace(database_, kPutLeg);
    version_ = database_.number("PRAGMA data_version");
    load();
    if (options) take(*options);
    fresh_.keep();
  }

  /// Makes calls of the builder; they are kept, or the builder is as it was.
  void keep(const std::function<void()>& call, const StoredSession* session = nullptr) {
    naming_store(file_, [&] {
      const Busy busy(busy_);
      begin();
      journal_.clear();
      attempt(call, session);
      commit(session);
    });
  }

  [[nodiscard]] MapBuilder& builder() {
    if (!builder_) {
      throw InputError(file_.string(), 0,
                       "could not be read again after a call that failed, expected to be opened "
                       "anew");
    }
    return *builder_;
  }

  [[nodiscard]] std::int64_t legs() const { return legs_; }

  [[nodiscard]] std::vector<StoredSession> sessions() const {
    return naming_store(
        file_, [&] { return undamaged_store(file_, [&] { return sessions_in(database_); }); });
  }

  [[nodiscard]] bool has_session(const std::string& key) const {
    return naming_store(file_, [&] {
      Statement statement(database_, "SELECT 1 FROM sessions WHERE key = ?");
      statement.bind(0, key);
      return statement.step();
    });
  }

  void for_each_leg(const std::function<void(const StoredLeg&)>& visit) {
    naming_store(file_, [&] {
      const Busy busy(busy_);
      Statement rows(database_, kLegs);
      const LandmarkGraph& graph = BuilderAccess::memory(builder()).graph;
      const std::int64_t count = std::ssize(sessions());
      std::int64_t number = 0;
      while (rows.step()) {
        visit(undamaged_store(file_, [&] { return leg_in(rows, number++, graph, count); }));
      }
      if (number != legs_) {
        throw InputError(file_.string(), 0, "is damaged: it has a leg that is misnumbered");
      }
    });
  }

  [[nodiscard]] std::string note(const std::string& name) {
    return naming_store(file_, [&] { return facts_->text("note:" + name); });
  }

  void set_note(const std::string& name, const std::string& text) {
    keep([&] { facts_->put("note:" + name, text); });
  }

 private:
  /// No call of the store within another one: it would keep half of that.
  class Busy {
   public:
    explicit Busy(bool& busy) : busy_(busy) {
      if (busy) throw std::logic_error("a map store is used within a call of its own");
      busy = true;
    }
    ~Busy() { busy_ = false; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

   private:
    bool& busy_;
  };

  Database open(bool must_be_new) {
    return naming_store(file_, [&] {
      const fs::path place = place_of_store(file_);
      std::error_code ignored;
      if (must_be_new && fs::exists(place, ignored)) {
        throw InputError(file_.string(), 0, "is there already, expected a new file");
      }
      Database database(place, Database::Access::write);
      static_cast<void>(is_store(file_, database));  // before anything is changed
      database.run("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON");
      Statement wal(database, "PRAGMA journal_mode = WAL");
      if (!wal.step() || wal.text(0) != "wal") {
        throw InputError(file_.string(), 0,
                         "lies where no map store can: the file system has no shared memory");
      }
      database.run("PRAGMA synchronous = FULL");
      return database;
    });
  }

  void load() {
    undamaged_store(file_, [&] {
      const MapBuilderOptions options = options_among(*facts_);
      builder_.emplace(BuilderAccess::restored(rows_->load(options), options));
      legs_ = legs_in(database_);
      static_cast<void>(sessions_in(database_));
    });
    BuilderAccess::keep_journal(*builder_, &journal_);
  }

  /// A map without landmarks may still change its method.
  void take(const MapBuilderOptions& options) {
    const bool empty = builder().landmarks() == 0;
    if (!empty) builder().set_options(options);
    keep([&] { put_options_among(*facts_, options); });
    if (empty) load();
  }

  /// A program without our lock (SQLite's own, say) may have written since the last call: that map
  /// this builder does not know.
  void begin() {
    static_cast<void>(builder());
    database_.run("BEGIN IMMEDIATE");
    if (database_.number("PRAGMA data_version") == version_) return;
    database_.run("ROLLBACK");
    throw InputError(file_.string(), 0,
                     "was written by another program meanwhile, expected to be opened anew");
  }

  /// A single call that throws leaves the builder as it was; a session must be undone.
  void attempt(const std::function<void()>& call, const StoredSession* session) {
    try {
      call();
      check_same_builder();
    } catch (...) {
      if (session != nullptr || !journal_.empty()) {
        go_back();
      } else {
        database_.run("ROLLBACK");
      }
      throw;
    }
  }

  /// A session may have put another builder in the place of this one.
  void check_same_builder() {
    if (BuilderAccess::has_journal(builder(), &journal_)) return;
    throw std::logic_error("a session drives the store's builder on, and keeps it");
  }

  void commit(const StoredSession* session) {
    try {
      put_legs(session);
      rows_->save(BuilderAccess::settle_memory(*builder_), builder_->options());
      database_.run("COMMIT");
    } catch (...) {
      go_back();
      throw;
    }
    legs_ += static_cast<std::int64_t>(journal_.size());
  }

  /// What the present call did, and the session that it is, if it is one.
  void put_legs(const StoredSession* session) {
    std::optional<std::int64_t> place;
    if (session != nullptr) {
      place = put_session(database_, {session->key, session->name, legs_, std::ssize(journal_)});
      put_options_among(*facts_, builder_->options());  // which may have been set on the way
    }
    std::int64_t number = legs_;
    for (const map::BuilderCall& call : journal_) {
      put_leg(*put_leg_, call, number++, place);
      put_leg_->run();
    }
  }

  /// To what the file holds.
  void go_back() noexcept {
    try {
      builder_.reset();
      if (database_.in_transaction()) database_.run("ROLLBACK");
      database_.run("BEGIN");
      load();
      version_ = database_.number("PRAGMA data_version");  // a failed write may change it, too
      database_.run("COMMIT");
    } catch (...) {
      builder_.reset();
    }
  }

  fs::path file_;
  std::unique_ptr<FileLock> lock_;
  FreshFile fresh_;
  Database database_;
  std::optional<MemoryRows> rows_;
  std::optional<Facts> facts_;
  std::optional<Statement> put_leg_;
  std::optional<MapBuilder> builder_;
  std::vector<map::BuilderCall> journal_;  // of the present call
  bool busy_ = false;                      // a call is under way
  std::int64_t legs_ = 0;
  std::int64_t version_ = 0;  // changes when another program has written
};

MapStore::MapStore(const fs::path& file, const std::optional<MapBuilderOptions>& options,
                   const MapBuilderOptions& if_new)
    : impl_(naming_store(file, [&] {
        // Refuses options out of range before there is a file.
        const MapBuilder in_range(options.value_or(if_new));
        return std::make_unique<Impl>(file, options, if_new, nullptr);
      })) {}
MapStore::MapStore(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MapStore::~MapStore() = default;
MapStore::MapStore(MapStore&&) noexcept = default;
MapStore& MapStore::operator=(MapStore&&) noexcept = default;

MapStore MapStore::create(const fs::path& file, const LandmarkGraph& map,
                          const MapBuilderOptions& options) {
  const MapBuilder first(map, options);
  return MapStore(
      naming_store(file, [&] { return std::make_unique<Impl>(file, options, options, &first); }));
}

MapStore MapStore::create(const fs::path& file, const MapBuilder& builder) {
  return MapStore(naming_store(file, [&] {
    return std::make_unique<Impl>(file, builder.options(), builder.options(), &builder);
  }));
}

void MapStore::start(const std::string& landmark, const Vector2& position) {
  impl_->keep([&] { impl_->builder().start(landmark, position); });
}

void MapStore::start(const std::string& landmark, const LandmarkOffset& seen,
                     const Vector2& position) {
  impl_->keep([&] { impl_->builder().start(landmark, seen, position); });
}

Arrival MapStore::arrive(const std::string& landmark, const Traversal& leg) {
  Arrival arrival;
  impl_->keep([&] { arrival = impl_->builder().arrive(landmark, leg); });
  return arrival;
}

Arrival MapStore::observe(const std::string& landmark, const Traversal& from_here) {
  Arrival arrival;
  impl_->keep([&] { arrival = impl_->builder().observe(landmark, from_here); });
  return arrival;
}

void MapStore::compass(double reading, double sd) {
  impl_->keep([&] { impl_->builder().compass(reading, sd); });
}

Arrival MapStore::arrive(const std::string& landmark, const Motion& motion,
                         const LandmarkOffset& seen) {
  Arrival arrival;
  impl_->keep([&] { arrival = impl_->builder().arrive(landmark, motion, seen); });
  return arrival;
}

Arrival MapStore::observe(const std::string& landmark, const LandmarkOffset& seen) {
  Arrival arrival;
  impl_->keep([&] { arrival = impl_->builder().observe(landmark, seen); });
  return arrival;
}

double MapStore::relax() {
  double largest_move = 0.0;
  impl_->keep([&] { largest_move = impl_->builder().relax(); });
  return largest_move;
}

void MapStore::append(const std::string& key, const std::string& name,
                      const std::function<void(MapBuilder&)>& drive) {
  if (key.empty() || has_session(key)) {
    throw std::invalid_argument("a session of a store needs a key of its own");
  }
  const StoredSession session{key, name, 0, 0};
  impl_->keep([&] { drive(impl_->builder()); }, &session);
}

const MapBuilder& MapStore::builder() const {
  return impl_->builder();
}

std::vector<StoredSession> MapStore::sessions() const {
  return impl_->sessions();
}

bool MapStore::has_session(const std::string& key) const {
  return impl_->has_session(key);
}

std::int64_t MapStore::legs() const {
  return impl_->legs();
}

void MapStore::for_each_leg(const std::function<void(const StoredLeg&)>& visit) const {
  impl_->for_each_leg(visit);
}

std::string MapStore::note(const std::string& name) const {
  return impl_->note(name);
}

void MapStore::set_note(const std::string& name, const std::string& text) {
  impl_->set_note(name, text);
}

}  // namespace trussmap
