#pragma once

#include <string_view>

namespace firn {

/// A number that a model remembers for each particle besides its strain.
struct HistoryColumn {
  std::string_view name;  ///< output column, for example "Jp"
  std::string_view unit;
  std::string_view help;
  double initial_value;
  bool plane_strain_only = false;  ///< not read or written in three dimensions; such columns are a model's last
};

/// Upper bound over all models, checked where the models are listed.
inline constexpr int kMaxHistoryColumns = 4;

// Columns that several models share.

/// Elastic strain across the plane of a two-dimensional scene. Plastic flow there makes room for elastic strain
/// although the total strain stays zero; without it plane strain would not be a slice of three dimensions.
inline constexpr HistoryColumn kElasticStrainZz = {
    .name = "elastic_strain_zz",
    .unit = "",
    .help = "Out-of-plane elastic Hencky strain.",
    .initial_value = 0,
    .plane_strain_only = true,
};

inline constexpr HistoryColumn kLogJp = {
    .name = "log_Jp",
    .unit = "",
    .help = "Logarithm of det Fp: above 0 opened for good, below 0 packed.",
    .initial_value = 0,
};

}  // namespace firn
