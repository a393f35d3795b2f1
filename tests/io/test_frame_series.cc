#include <firn/core/error.h>
#include <firn/io/frame_series.h>
#include <gtest/gtest.h>
#include "support/temporary_folder.h"

namespace firn {
namespace {

TEST(FrameSeries, IsTheTextThatParaViewReads) {
  const TemporaryFolder folder;
  write_frame_series(folder / kFrameSeriesName, {{"particles.0001.hdf", 0}, {"particles.0002.hdf", 1.0 / 24}});
  EXPECT_EQ(file_bytes(folder / kFrameSeriesName),
            "{\n \"file-series-version\": \"1.0\",\n \"files\": [\n"
            "  {\n   \"name\": \"particles.0001.hdf\",\n   \"time\": 0.0\n  },\n"
            "  {\n   \"name\": \"particles.0002.hdf\",\n   \"time\": 0.041666666666666664\n  }\n ]\n}\n");
}

TEST(FrameSeries, ReadsBackEqual) {
  const TemporaryFolder folder;
  write_frame_series(folder / "s", {{"a \"quoted\".hdf", 1.0 / 3}, {"b.hdf", 2e-300}});
  const std::vector<SeriesFrame> frames = read_frame_series(folder / "s");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].name, "a \"quoted\".hdf");
  EXPECT_EQ(frames[0].time, 1.0 / 3);
  EXPECT_EQ(frames[1].time, 2e-300);
}

TEST(FrameSeries, DamagedFileIsRefused) {
  const TemporaryFolder folder;
  for (const char* text : {"", "{\"files\": 3}", "{\"files\": [{\"name\": 1}]}", "[1, 2"}) {
    std::ofstream(folder / "s") << text;
    EXPECT_THROW(read_frame_series(folder / "s"), Error) << text;
  }
  EXPECT_THROW(read_frame_series(folder / "absent"), Error);
}

}  // namespace
}  // namespace firn
