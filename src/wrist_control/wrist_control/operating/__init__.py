"""What an operator asks of the hand: maneuvers, and a joystick held in the hand."""
