"""What the controller knows as tables: alarms, codes, parameters, signals."""
