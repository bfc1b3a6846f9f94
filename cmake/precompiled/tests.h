// SPDX-License-Identifier: Apache-2.0
// What most test files include, see product.h.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "product.h"
