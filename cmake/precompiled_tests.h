#pragma once

#include "precompiled_sources.h"
#include <gtest/gtest.h>
