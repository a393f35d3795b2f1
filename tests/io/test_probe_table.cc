#include <firn/core/error.h>
#include <firn/io/probe_table.h>
#include <gtest/gtest.h>
#include "support/temporary_folder.h"

#include <limits>

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

}  // namespace
}  // namespace firn
