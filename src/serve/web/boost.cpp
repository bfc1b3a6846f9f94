// SPDX-License-Identifier: Apache-2.0
// The functions of Boost.Beast and of Boost.Asio's TLS that are no templates. They are compiled
// here once (BOOST_BEAST_SEPARATE_COMPILATION).
#include "serve/web/boost.h"

#include <boost/asio/ssl/impl/src.hpp>
#include <boost/beast/src.hpp>
