function result = limcycle_continue (what, varargin)
% LIMCYCLE_CONTINUE  A limit cycle followed over a parameter.
%   RESULT = LIMCYCLE_CONTINUE (CASE, NAME, VALUE, ...): see LIMCYCLE.
  result = limcycle ('continue', what, varargin{:});
end
