#pragma once

#include "standIn.h"
