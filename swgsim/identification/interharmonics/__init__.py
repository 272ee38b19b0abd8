"""Lines between the orders: their spectrum, their patterns over the gauges, and the effects that explain them."""
