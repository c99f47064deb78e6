#include "revision_table.hpp"

#include <cstddef>
#include <string>

#include "number_blob.hpp"
#include "row_access.hpp"
#include "spherical_actuator_calibration/base/error.hpp"

namespace sac::revision_table {
namespace {

RevisionSummary readSummary(RowReader& row) {
  RevisionSummary summary;
  summary.number = row.count();
  summary.date = row.text();
  summary.software = row.text();
  summary.source = row.text();
  summary.origin = row.text();
  summary.refined = row.flag();
  return summary;
}

/// One byte per coordinate, 0 or 1.
std::string bytesOf(const std::vector<bool>& flags) {
  std::string bytes;
  bytes.reserve(flags.size());
  for (const bool flag : flags) {
    bytes.push_back(flag ? '\1' : '\0');
  }
  return bytes;
}

CalibrationState readState(RowReader& row) {
  const std::string coordinates = row.bytes();
  const std::string covariance = row.bytes();
  const std::string identified = row.bytes();
  const auto size = static_cast<Eigen::Index>(identified.size());
  CalibrationState state;
  state.belief.x = matrixOf(coordinates, size, 1);
  state.belief.covariance = symmetricOf(covariance, size);
  if (!state.belief.x.allFinite() || !state.belief.covariance.allFinite()) {
    throw RowDefect("parameters that are not finite");
  }
  state.identified.reserve(identified.size());
  for (const char byte : identified) {
    state.identified.push_back(byte != '\0');
  }
  return state;
}

/// The revision whose row holds this covariance already, among those that another one of the same
/// is likely to follow: the first one (reset), the predecessor (restore), the newest.
std::optional<std::uint32_t> holderOf(const SQLite::Database& database,
                                      const std::string& covariance,
                                      const Lineage& lineage) {
  RowReader row(database,
                "SELECT number FROM revisions WHERE covariance = ?1 AND number IN ("
                "SELECT coalesce(covariance_of, number) FROM revisions WHERE number = 0 "
                "OR number = ?2 OR number = (SELECT max(number) FROM revisions)) LIMIT 1");
  row.bindBytes(1, covariance);
  row.bind(2, lineage.predecessor.value_or(0));
  return row.next() ? std::optional(row.count()) : std::nullopt;
}

/// A revision, bound to the first place, and those before it, as the table `chain`. A predecessor
/// has the smaller number, so that the order of numbers is the order of the chain.
std::string chain() {
  return "WITH RECURSIVE chain (number, predecessor, cycle) AS ("
         "SELECT number, predecessor, cycle FROM revisions WHERE number = ? UNION ALL "
         "SELECT r.number, r.predecessor, r.cycle FROM revisions AS r "
         "JOIN chain ON r.number = chain.predecessor AND r.number < chain.number) ";
}

}  // namespace

void insert(const SQLite::Database& database, const Revision& revision, const Lineage& lineage) {
  RowWriter row(database,
                "INSERT INTO revisions (number, date, software, source, origin, refined, "
                "predecessor, cycle, coordinates, covariance, identified, covariance_of) "
                "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  row.put(revision.number).put(revision.date).put(revision.software).put(revision.source);
  row.put(revision.origin).put(revision.refined).put(lineage.predecessor).put(lineage.cycle);
  const std::string coordinates = blobOf(revision.state.belief.x);
  const std::string covariance = symmetricBlobOf(revision.state.belief.covariance);
  const std::optional<std::uint32_t> holder = holderOf(database, covariance, lineage);
  const std::string identified = bytesOf(revision.state.identified);
  const std::string nothing;
  row.putBytes(coordinates).putBytes(holder ? nothing : covariance).putBytes(identified);
  row.put(holder).write();
}

std::uint32_t newestNumber(const SQLite::Database& database) {
  RowReader row(database, "SELECT number FROM revisions ORDER BY number DESC LIMIT 1");
  if (!row.next()) {
    throw RowDefect("no parameters");
  }
  return row.count();
}

std::optional<Revision> find(const SQLite::Database& database, std::uint32_t number) {
  RowReader row(database,
                "SELECT r.number, r.date, r.software, r.source, r.origin, r.refined, "
                "r.coordinates, coalesce(holder.covariance, r.covariance), r.identified "
                "FROM revisions AS r LEFT JOIN revisions AS holder "
                "ON holder.number = r.covariance_of WHERE r.number = ?",
                number);
  if (!row.next()) {
    return std::nullopt;
  }
  Revision revision;
  static_cast<RevisionSummary&>(revision) = readSummary(row);
  revision.state = readState(row);
  return revision;
}

std::vector<RevisionSummary> all(const SQLite::Database& database) {
  RowReader row(database,
                "SELECT number, date, software, source, origin, refined FROM revisions "
                "ORDER BY number");
  std::vector<RevisionSummary> summaries;
  while (row.next()) {
    summaries.push_back(readSummary(row));
  }
  return summaries;
}

std::vector<std::int64_t> cyclesOf(const SQLite::Database& database, std::uint32_t number) {
  RowReader row(
      database,
      (chain() +
       "SELECT cycle AS id FROM chain WHERE cycle IS NOT NULL UNION "
       "SELECT cycles.id FROM cycles JOIN chain ON cycles.in_force = chain.number "
       "WHERE cycles.success = 0 AND (chain.number = ?1 OR EXISTS (SELECT 1 FROM chain AS next "
       "WHERE next.predecessor = chain.number AND next.cycle IS NOT NULL)) ORDER BY id")
          .c_str(),
      number);
  std::vector<std::int64_t> cycles;
  while (row.next()) {
    cycles.push_back(row.integer());
  }
  return cycles;
}

std::optional<std::uint32_t> lastOfMotion(const SQLite::Database& database, std::uint32_t number) {
  RowReader row(database,
                (chain() + "SELECT number FROM chain JOIN cycles ON cycles.id = chain.cycle "
                           "WHERE cycles.cycle = 'motion' ORDER BY number DESC LIMIT 1")
                    .c_str(),
                number);
  return row.next() ? std::optional(row.count()) : std::nullopt;
}

}  // namespace sac::revision_table
