// SPDX-License-Identifier: Apache-2.0
// Boost.Asio's functions that are not templates, compiled once here: BOOST_ASIO_SEPARATE_COMPILATION.
#include <utility>  // before Asio, which uses std::exchange without it

#include <boost/asio/impl/src.hpp>
