#pragma once
#include "ros2_stand_in.h"
