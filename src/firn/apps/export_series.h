#pragma once

#include <firn/apps/export_target.h>

#include <map>
#include <string>
#include <vector>

namespace firn {

/// What is in the files of an export.
struct ExportedSeries {
  std::string format;
  std::string client;
  UpAxis up = UpAxis::y;
  double spacing = 0;                   ///< of the particles, m
  std::vector<std::string> attributes;  ///< names in the files
  std::map<std::string, std::string> units;
  std::vector<std::string> materials;
};

/// Writes "NAME.FORMAT.series.json", and "NAME.series.json" of the newest export, beside the files: what they are, and
/// of each its frame and time. Scripts read it.
/// Throws Error (files).
void write_series_description(const ExportTarget& target, const FrameList& list, const ExportedSeries& series);

/// What to click in the client to see the files; "" without a client or for a pair that makes no sense.
std::string next_clicks(Client client, const std::string& format, const ExportTarget& target, const FrameList& list);

}  // namespace firn
