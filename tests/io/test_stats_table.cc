#include <firn/core/error.h>
#include <firn/io/stats_table.h>
#include <gtest/gtest.h>
#include "support/temporary_folder.h"

#include <limits>

namespace firn {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',') {
      fields.emplace_back();
    } else if (c != '\n') {
      fields.back() += c;
    }
  }
  return fields;
}

TEST(StatsTable, BeginsWithTheDeclaredColumns) {
  const TemporaryFolder folder;
  const StatsTable table(folder / "stats.csv", {"parked"});
  EXPECT_EQ(file_bytes(folder / "stats.csv"),
            "frame,time,steps,dt,limit,particles,mass,momentum_x,momentum_y,momentum_z,angular_momentum_x,"
            "angular_momentum_y,angular_momentum_z,kinetic_energy,elastic_energy,gravitational_energy,max_speed,volume,"
            "volume_drift,min_J,max_J,wall_seconds,parked\n");
  for (const StatsColumn& column : stats_columns()) EXPECT_FALSE(column.help.empty()) << column.name;
}

TEST(StatsTable, NumbersReadBackToTheSameBits) {
  const TemporaryFolder folder;
  StatsTable table(folder / "stats.csv", {"parked"});
  StatsRow row{.frame = 3, .time = 1.0 / 24, .steps = 1234567890123, .dt = 1e-4 / 3, .limit = "elastic wave"};
  row.momentum[1] = -std::numeric_limits<double>::denorm_min();
  row.angular_momentum[2] = 0.1 + 0.2;
  row.max_J = std::numeric_limits<double>::max();
  row.further = {7};
  table.append(row);
  const std::string text = file_bytes(folder / "stats.csv");
  const std::vector<std::string> fields = split(text.substr(text.find('\n') + 1));
  ASSERT_EQ(fields.size(), 23U);
  EXPECT_EQ(std::stod(fields[1]), 1.0 / 24);
  EXPECT_EQ(fields[2], "1234567890123");
  EXPECT_EQ(std::stod(fields[3]), 1e-4 / 3);
  EXPECT_EQ(fields[4], "elastic wave");
  EXPECT_EQ(std::strtod(fields[8].c_str(), nullptr), -std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(std::stod(fields[12]), 0.1 + 0.2);
  EXPECT_EQ(std::stod(fields[20]), std::numeric_limits<double>::max());
  EXPECT_EQ(fields[22], "7");
}

TEST(StatsTable, TextWithACommaIsQuoted) {
  const TemporaryFolder folder;
  StatsTable table(folder / "stats.csv");
  table.append({.limit = "wave of \"ice, old\""});
  EXPECT_NE(file_bytes(folder / "stats.csv").find(",\"wave of \"\"ice, old\"\"\","), std::string::npos);
}

TEST(StatsTable, ErrorsNameTheFile) {
  const TemporaryFolder folder;
  EXPECT_THROW(StatsTable(folder / "absent/stats.csv"), Error);
  StatsTable table(folder / "stats.csv");
  EXPECT_THROW(table.append({.further = {1}}), Error);
  std::filesystem::remove(folder / "stats.csv");
  try {
    table.append({});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
    EXPECT_NE(std::string(error.what()).find("stats.csv: cannot add a row: No such file"), std::string::npos);
  }
}

TEST(StatsTable, ResumedKeepsRowsReplacesLaterOnesAndDropsATornLine) {
  const TemporaryFolder folder;
  const auto path = folder / "stats.csv";
  const auto row = [](std::int64_t frame, double mass) {
    StatsRow r;
    r.frame = frame, r.mass = mass;
    return r;
  };
  {
    StatsTable table(path);
    for (std::int64_t frame = 1; frame <= 4; ++frame) table.append(row(frame, 1));
  }
  const std::string whole = file_bytes(path);
  std::ofstream(path, std::ios::app) << "5,0.2,";  // killed while it wrote
  {
    StatsTable table = StatsTable::resume(path, {}, 2, true);
    EXPECT_EQ(file_bytes(path), whole) << "later rows stay";
    table.append(row(3, 1));
    EXPECT_EQ(file_bytes(path), whole) << "replaced by its like";
    table.append(row(4, 1));
    EXPECT_EQ(file_bytes(path), whole);
    table.append(row(5, 1));
    EXPECT_TRUE(file_bytes(path).starts_with(whole));
    EXPECT_EQ(file_bytes(path).find("5,0.2"), std::string::npos);
    table.sync();
  }
  StatsTable::resume(path, {}, 4, false);
  EXPECT_EQ(file_bytes(path), whole) << "later rows of another scene go";
  std::filesystem::remove(path);
  StatsTable::resume(path, {}, 2, true).append(row(3, 1));
  EXPECT_NE(file_bytes(path).find("\n3,"), std::string::npos) << "a lost table is begun anew";
}

TEST(StatsTable, FullDiskIsAnError) {
  StatsTable* table = nullptr;
  EXPECT_THROW(table = new StatsTable("/dev/full"), Error);
  EXPECT_EQ(table, nullptr);
}

}  // namespace
}  // namespace firn
