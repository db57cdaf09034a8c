"""The reference manual, generated from the tables that the controller and the adviser run on."""
