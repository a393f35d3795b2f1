#include <firn/core/error.h>
#include <firn/io/probe_table.h>
#include <gtest/gtest.h>
#include "support/temporary_folder.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace firn {
namespace {

TEST(ProbeTable, HasARowForEachFrameAndPoint) {
  const TemporaryFolder folder;
  ProbeTable table(folder / "column.csv");
  const std::string header = "frame,time,point,x,y,z,density,velocity_x,velocity_y,velocity_z,pressure\n";
  EXPECT_EQ(file_bytes(folder / "column.csv"), header);
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  const std::vector<ProbeRow> rows = {{{{0.1, 0, -2}}, 1000, {{1, 2.5, 0}}, -3},
                                      {{{0.2, 0, -2}}, 0, {{kNothing, kNothing, kNothing}}, kNothing}};
  table.append(1, 0, rows);
  table.append(2, 0.5, std::span(rows).first(1));
  EXPECT_EQ(file_bytes(folder / "column.csv"),
            header + "1,0,0,0.1,0,-2,1000,1,2.5,0,-3\n1,0,1,0.2,0,-2,0,,,,\n2,0.5,0,0.1,0,-2,1000,1,2.5,0,-3\n");
}

TEST(ProbeTable, SaysWhereItCannotBeWritten) {
  const TemporaryFolder folder;
  ProbeTable table(folder / "column.csv");
  std::filesystem::remove(folder / "column.csv");
  try {
    table.append(1, 0, std::vector<ProbeRow>(1));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
    EXPECT_NE(std::string(error.what()).find("column.csv: cannot add a row"), std::string::npos) << error.what();
  }
}

TEST(ProbeTable, ResumedKeepsFramesReplacesLaterOnesAndDropsATornLine) {
  const TemporaryFolder folder;
  const auto path = folder / "column.csv";
  const std::vector<ProbeRow> rows(3);
  {
    ProbeTable table(path);
    for (std::int64_t frame = 1; frame <= 4; ++frame) table.append(frame, 0.5, rows);
  }
  const std::string whole = file_bytes(path);
  const std::string two = whole.substr(0, whole.find("\n3,") + 1);
  std::ofstream(path, std::ios::app) << "5,0.5,0,0,0,0,0,0,0,0,0\n5,0.5,1,";  // killed while it wrote
  ProbeTable table = ProbeTable::resume(path, 2, true);
  EXPECT_TRUE(file_bytes(path).starts_with(whole)) << "later frames stay";
  for (std::int64_t frame = 3; frame <= 4; ++frame) {
    table.append(frame, 0.5, rows);
    EXPECT_TRUE(file_bytes(path).starts_with(whole)) << "replaced by their like";
  }
  table.append(5, 0.5, rows);
  const std::string five = file_bytes(path);
  EXPECT_EQ(std::count(five.begin(), five.end(), '\n'), 16);
  table.sync();
  ProbeTable::resume(path, 2, false);
  EXPECT_EQ(file_bytes(path), two) << "later frames of another scene go";
  std::filesystem::remove(path);
  ProbeTable::resume(path, 2, true).append(3, 0.5, rows);
  EXPECT_NE(file_bytes(path).find("\n3,"), std::string::npos) << "a lost table is begun anew";
}

}  // namespace
}  // namespace firn
