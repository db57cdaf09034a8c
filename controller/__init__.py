"""The emulated CNC: program text in, setpoints out. Knows neither physics nor geometry."""
