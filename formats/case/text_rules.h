// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/container/text_rules.h"
