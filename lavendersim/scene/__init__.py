"""A resolved config enters; mass properties, engine arrays and the plan leave."""
