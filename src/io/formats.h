// The public header, under the name the rooms use.
#pragma once

#include "curvetet/formats.h"
